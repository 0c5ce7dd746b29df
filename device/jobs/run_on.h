// Bound on how much of a job a machine executes after an abort.
#pragma once

#include <cstddef>

#include "device/core/time.h"

namespace axisgate::jobs {

// A RunOn is the greatest number of bytes of the job that a mill may still execute after an abort.
struct RunOn {
  // For a mill that is not paused at its panel, takes no longer than SendSettings::slack allows, and began the job with
  // the tool at the top above the work origin.
  std::size_t at_most = 0;
  // For a mill that is paused at its panel: bytes that it may execute after it is released.
  std::size_t if_held = 0;
  // Longest time that the slowest mill needs for any `at_most` consecutive bytes of the job.
  Duration longest{};
  // Longest distance, in mm, that the tool moves for any `at_most` consecutive bytes of the job.
  double mm = 0;

  friend bool operator==(const RunOn&, const RunOn&) = default;
};

}  // namespace axisgate::jobs
