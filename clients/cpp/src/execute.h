// Lines in the controller's own language.
#pragma once

#include <string>
#include <vector>

#include "clients/cpp/src/session.h"

namespace axisgate::client {

// Sends lines, once. See Stage::execute().
Executed execute(DeviceSession& session, const std::vector<std::string>& lines);

}  // namespace axisgate::client
