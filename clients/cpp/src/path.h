// The start of a path.
#pragma once

#include <vector>

#include "clients/cpp/src/session.h"

namespace axisgate::client {

// Sends a path, and returns its motion once it has started.
Motion start_path(DeviceSession& session, const std::vector<v1::Segment>& segments);

}  // namespace axisgate::client
