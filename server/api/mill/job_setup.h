// Requirements of a job at the mill, and the right to confirm it there.
#pragma once

#include <string>
#include <string_view>

#include "device/core/problem.h"
#include "device/jobs/job.h"
#include "server/devices/mill.h"

namespace axisgate::api {

// Fails with setup_changed if the configuration no longer matches the one for which the job was checked.
Result<void> check_setup(const server::Mill& mill, const jobs::Job& job);

// Fails with not_allowed if the caller is not at the mill's station.
Result<void> check_at_station(const server::Mill& mill, std::string_view who);

}  // namespace axisgate::api
