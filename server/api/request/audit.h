// Log lines about callers who request changes. The results are logged by server/devices/device_events.
#pragma once

#include <string_view>

#include "device/stage/requests.h"
#include "server/api/request/request_kinds.h"
#include "server/devices/device.h"

namespace axisgate::api {

// Both functions log only kinds whose rule is audited. `what` may contain bytes from the caller: it is escaped, and cut
// at 400 characters. Thread safe.

// Logs a finished operation. `what` continues after the caller's name: "revoked the token night-scan".
void audit(RequestKind kind, std::string_view who, std::string_view what);

// Logs a request that is now passed to its device: "move axis 1 to 5 mm".
void audit(RequestKind kind, const server::Device& device, const use::RequestContext& context, std::string_view what);

}  // namespace axisgate::api
