// What a job needs at the mill, and who may confirm it there.
#pragma once

#include <string>
#include <string_view>

#include "device/core/problem.h"
#include "device/rml1/mill/job.h"
#include "server/devices/mill.h"

namespace axisgate::api {

// stale_setpoint: the configuration may have changed since the job was sent.
Result<void> check_setup(const server::Mill& mill, const rml1::Job& job);

// Returns the name of the machine that has the profile. Empty: empty. Fails with invalid_request if there is none.
Result<std::string> machine_with_profile(const server::MillConfig& config, std::string_view profile);

// not_allowed: the caller is not at the mill's station.
Result<void> check_at_station(const server::Mill& mill, std::string_view who);

}  // namespace axisgate::api
