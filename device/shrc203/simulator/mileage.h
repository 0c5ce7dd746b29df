// Distance that an axis has moved since counting began, as counted by the trigger output (manual 98), 101)).
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>

namespace axisgate::shrc203::simulator {

// Distances in pulses. `highest` and `lowest` are the extreme positions, relative to the start of counting.
struct Mileage {
  std::int64_t total = 0;
  std::int64_t net = 0;
  std::int64_t highest = 0;
  std::int64_t lowest = 0;

  // Adds a movement without a change of direction.
  void add(std::int64_t amount) {
    total += std::abs(amount);
    net += amount;
    highest = std::max(highest, net);
    lowest = std::min(lowest, net);
  }
};

}  // namespace axisgate::shrc203::simulator
