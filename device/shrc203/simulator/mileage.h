// How far an axis has gone since the counting began: what a trigger output counts (manual 98), 101)).
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>

namespace axisgate::shrc203::simulator {

// Pulses. `highest` and `lowest` are the furthest that it has been from where the counting began.
struct Mileage {
  std::int64_t total = 0;
  std::int64_t net = 0;
  std::int64_t highest = 0;
  std::int64_t lowest = 0;

  // On by so much without turning round.
  void add(std::int64_t amount) {
    total += std::abs(amount);
    net += amount;
    highest = std::max(highest, net);
    lowest = std::min(lowest, net);
  }
};

}  // namespace axisgate::shrc203::simulator
