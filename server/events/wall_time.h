// Where the machines' monotonic time meets the calendar.
#pragma once

#include <chrono>

#include "device/core/time.h"
#include "device/link/clock.h"

namespace axisgate::server {

using WallTime = std::chrono::system_clock::time_point;

// Between the two clocks as they stand now: a clock that was set in between shifts old times along. The epoch of the
// monotonic clock means "never" and stays the calendar's epoch.
inline WallTime to_wall(TimePoint time) {
  if (time == TimePoint{}) return {};
  return std::chrono::system_clock::now() + std::chrono::duration_cast<WallTime::duration>(time - monotonic_now());
}

// One moment on both clocks. By it all times of one thing keep their distances, and are the same whenever they are
// read.
struct Moment {
  TimePoint monotonic{};
  WallTime wall{};

  WallTime at(TimePoint time) const { return wall + std::chrono::duration_cast<WallTime::duration>(time - monotonic); }
  TimePoint of(WallTime time) const { return monotonic + std::chrono::duration_cast<Duration>(time - wall); }
};

inline Moment moment_of(TimePoint time) { return {time, to_wall(time)}; }

// Whole seconds, for what outlives the daemon.
inline std::chrono::sys_seconds calendar_now() {
  return std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
}

inline TimePoint to_monotonic(WallTime time) {
  return monotonic_now() + std::chrono::duration_cast<Duration>(time - std::chrono::system_clock::now());
}

}  // namespace axisgate::server
