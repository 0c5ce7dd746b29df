// Path and questions of the paced-path tests, the same in virtual time and over a pty.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <string_view>

namespace axisgate::paced {

inline constexpr int kCallers = 16;

// A different question for each caller, because equal questions that wait share an exchange.
inline constexpr std::array<std::string_view, kCallers> kOwnQuestions = {
    "*IDN?", "?:D",  "Q:",  "Q:S", "SRQ:", "!:",  "!:S",  "?:V",
    "?:MP",  "?:AP", "?:M", "?:A", "?:KP", "?:K", "?:EP", "?:SN"};

// Straight segments of axes 1 and 2, back and forth: 3 and 4 units long, 5 along the line. Every twentieth segment
// returns by a different displacement, so that the path ends near the places in between but at none of them.
struct Track {
  static constexpr std::int64_t kSpeed = 20'000;  // pulses/s
  std::chrono::milliseconds each;

  std::int64_t unit() const { return kSpeed * each.count() / 1000 / 5; }
  std::array<std::int64_t, 2> way(int segment) const {  // counted from 0
    if (segment % 2 == 0) return {3 * unit(), 4 * unit()};
    if (segment % 20 == 19) return {-4 * unit(), -3 * unit()};
    return {-3 * unit(), -4 * unit()};
  }
  std::array<std::int64_t, 2> end(int segments) const {
    std::array<std::int64_t, 2> sum{};
    for (int i = 0; i < segments; ++i) {
      for (std::size_t axis = 0; axis < sum.size(); ++axis) sum[axis] += way(i)[axis];
    }
    return sum;
  }
};

}  // namespace axisgate::paced
