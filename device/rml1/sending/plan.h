// The plan of a job, computed before it is sent. That reads the whole job: do it off the device's strand.
#pragma once

#include <cstddef>
#include <string_view>

#include "device/core/time.h"
#include "device/rml1/sending/settings.h"
#include "device/rml1/sending/timeline.h"

namespace axisgate::rml1 {

// A RunOn bounds what a mill may still execute after an abort, in bytes of the job.
struct RunOn {
  // For a mill that executes, takes no longer than SendPlan::slack says, and began at the top above the work origin.
  std::size_t at_most = 0;
  // For a mill that its panel holds, once it is released.
  std::size_t if_held = 0;
  // Longest time that the slowest mill needs for any `at_most` bytes of the job.
  Duration longest{};
  // Longest distance that its tool moves in that time.
  double mm = 0;

  friend bool operator==(const RunOn&, const RunOn&) = default;
};

struct SendPlan {
  std::size_t window = 0;  // bytes, of paced streaming
  double slack = 1;        // SendSettings::slack
  RunOn run_on;
};

SendPlan plan_of(std::string_view job, const Timeline& timeline, const SendSettings& settings);

}  // namespace axisgate::rml1
