// What is computed of a job before it is sent. It reads the whole job, so not on a device's strand.
#pragma once

#include <cstddef>
#include <string_view>

#include "device/core/time.h"
#include "device/rml1/sending/settings.h"
#include "device/rml1/sending/timeline.h"

namespace axisgate::rml1 {

// What may be executed after an abort, in bytes of the job.
struct RunOn {
  // Of a mill that executes, takes no longer than SendPlan::slack says, and began at the top above the work origin.
  std::size_t at_most = 0;
  // Of one that its panel holds, for when it is released.
  std::size_t if_held = 0;
  // Within which the slowest mill has executed any `at_most` bytes of the job.
  Duration longest{};
  // How far its tool moves meanwhile, at most.
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
