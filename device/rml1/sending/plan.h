// Plan for sending a job, computed before the job is sent.
#pragma once

#include <cstddef>
#include <string_view>

#include "device/core/time.h"
#include "device/jobs/run_on.h"
#include "device/jobs/send_settings.h"
#include "device/rml1/sending/timeline.h"

namespace axisgate::rml1 {

struct SendPlan {
  std::size_t window = 0;  // in bytes, for paced streaming
  double slack = 1;        // SendSettings::slack
  jobs::RunOn run_on;
};

// Computes the plan. Reads the whole job, so do not call it on the device's strand.
SendPlan plan_of(std::string_view job, const Timeline& timeline, const jobs::SendSettings& settings);

}  // namespace axisgate::rml1
