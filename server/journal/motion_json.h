// A motion and a problem as JSON, for texts that outlive the daemon. What reads it throws nlohmann::json::exception
// where it is something else.
#pragma once

#include <nlohmann/json.hpp>

#include "device/core/problem.h"
#include "device/stage/motion.h"

namespace axisgate::server::journal {

nlohmann::json json_of(const Problem& problem);
Problem problem_of(const nlohmann::json& json);

// Without its times: which clock they are written by depends on the text.
nlohmann::json json_of(const stage::Motion& motion);
stage::Motion motion_of(const nlohmann::json& json);

}  // namespace axisgate::server::journal
