// The choice of a device among those that the daemon lists.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "clients/cpp/src/session.h"

namespace axisgate::client {

// Connects to the daemon and chooses the stage of the options. Throws Unavailable, and InvalidArgument if there is no
// such stage, or several and none is named.
std::shared_ptr<DeviceSession> open_stage(const ConnectOptions& options);

// Returns the names of the daemon's stages. Throws Unavailable.
std::vector<std::string> stage_names(const ConnectOptions& options);

}  // namespace axisgate::client
