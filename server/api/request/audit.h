// Who requested what changes something, in the log. What became of it follows there: server/devices/device_events.
#pragma once

#include <string_view>

#include "device/stage/requests.h"
#include "server/api/request/request_kinds.h"
#include "server/devices/device.h"

namespace axisgate::api {

// Nothing of a kind whose rule is not audited. `what` may hold bytes of the caller's: it is escaped, and cut at 400
// characters. Thread safe.

// After it was done. `what` follows the caller's name: "revoked the token night-scan".
void audit(RequestKind kind, std::string_view who, std::string_view what);

// Of a request that is handed to its device now: "move axis 1 to 5 mm".
void audit(RequestKind kind, const server::Device& device, const stage::RequestContext& context, std::string_view what);

}  // namespace axisgate::api
