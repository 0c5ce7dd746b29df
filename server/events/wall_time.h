// Conversion between monotonic time and the calendar.
#pragma once

#include <chrono>

#include "device/core/time.h"
#include "device/link/clock.h"

namespace axisgate::server {

using WallTime = std::chrono::system_clock::time_point;

// Converts with the present difference of the two clocks: if a clock was set in between, old times shift with it. The
// epoch of the monotonic clock means "never" and becomes the calendar's epoch.
inline WallTime to_wall(TimePoint time) {
  if (time == TimePoint{}) return {};
  return std::chrono::system_clock::now() + std::chrono::duration_cast<WallTime::duration>(time - monotonic_now());
}

// A Moment is one moment on both clocks. Times that are converted by the same Moment keep their distances, and are
// always converted to the same values.
struct Moment {
  TimePoint monotonic{};
  WallTime wall{};

  WallTime at(TimePoint time) const { return wall + std::chrono::duration_cast<WallTime::duration>(time - monotonic); }
  TimePoint of(WallTime time) const { return monotonic + std::chrono::duration_cast<Duration>(time - wall); }
};

inline Moment moment_of(TimePoint time) { return {time, to_wall(time)}; }

// Returns whole seconds, for data that outlives the daemon.
inline std::chrono::sys_seconds calendar_now() {
  return std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
}

inline TimePoint to_monotonic(WallTime time) {
  return monotonic_now() + std::chrono::duration_cast<Duration>(time - std::chrono::system_clock::now());
}

}  // namespace axisgate::server
