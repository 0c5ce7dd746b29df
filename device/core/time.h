// Time as the state machines see it: it is handed to them, never read.
#pragma once

#include <chrono>
#include <cstdint>

namespace axisgate {

using Duration = std::chrono::nanoseconds;

// Monotonic time. Deliberately without now(): production reads the clock in device/link and server only,
// tests and the seeded simulation invent it.
struct MonotonicClock {
  using rep = std::int64_t;
  using period = std::nano;
  using duration = Duration;
  using time_point = std::chrono::time_point<MonotonicClock>;
  static constexpr bool is_steady = true;
};

using TimePoint = MonotonicClock::time_point;

}  // namespace axisgate
