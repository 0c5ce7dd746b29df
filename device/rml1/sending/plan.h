// The plan of a job, computed before it is sent. That reads the whole job: do it off the device's strand.
#pragma once

#include <cstddef>
#include <string_view>

#include "device/core/time.h"
#include "device/jobs/run_on.h"
#include "device/jobs/send_settings.h"
#include "device/rml1/sending/timeline.h"

namespace axisgate::rml1 {

struct SendPlan {
  std::size_t window = 0;  // bytes, of paced streaming
  double slack = 1;        // SendSettings::slack
  jobs::RunOn run_on;
};

SendPlan plan_of(std::string_view job, const Timeline& timeline, const jobs::SendSettings& settings);

}  // namespace axisgate::rml1
