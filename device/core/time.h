// Time of the state machines, which is passed to them and which they never read from a clock.
#pragma once

#include <chrono>
#include <cstdint>

namespace axisgate {

using Duration = std::chrono::nanoseconds;

// Monotonic time. Deliberately without now(): production reads the clock in device/link and server only; tests and the
// seeded simulation invent the time.
struct MonotonicClock {
  using rep = std::int64_t;
  using period = std::nano;
  using duration = Duration;
  using time_point = std::chrono::time_point<MonotonicClock>;
  static constexpr bool is_steady = true;
};

using TimePoint = MonotonicClock::time_point;

}  // namespace axisgate
