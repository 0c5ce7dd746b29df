// Bound on what a machine executes after an abort.
#pragma once

#include <cstddef>

#include "device/core/time.h"

namespace axisgate::jobs {

// A RunOn bounds what a mill may still execute after an abort, in bytes of the job.
struct RunOn {
  // For a mill that executes, takes no longer than SendSettings::slack allows, and began at the top above the work
  // origin.
  std::size_t at_most = 0;
  // For a mill that its panel holds, once it is released.
  std::size_t if_held = 0;
  // Longest time that the slowest mill needs for any `at_most` bytes of the job.
  Duration longest{};
  // Longest distance that its tool moves in that time.
  double mm = 0;

  friend bool operator==(const RunOn&, const RunOn&) = default;
};

}  // namespace axisgate::jobs
