// JSON form of motions and problems, for texts that outlive the daemon. Reading throws nlohmann::json::exception if the
// JSON has another form.
#pragma once

#include <nlohmann/json.hpp>

#include "device/core/problem.h"
#include "device/stage/motion.h"

namespace axisgate::server::journal {

nlohmann::json json_of(const Problem& problem);
Problem problem_of(const nlohmann::json& json);

// Omits the times: the text that contains the JSON decides by which clock they are written.
nlohmann::json json_of(const stage::Motion& motion);
stage::Motion motion_of(const nlohmann::json& json);

}  // namespace axisgate::server::journal
