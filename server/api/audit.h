// Who changed what, in the log. A device's own changes and stops stand there already: server/devices/device_events.
#pragma once

#include <string_view>

#include "server/api/request_kinds.h"

namespace axisgate::api {

// After it was done. `what` follows the caller's name: "revoked the token night-scan". Nothing of a kind whose rule is
// not audited. Thread safe.
void audit(RequestKind kind, std::string_view who, std::string_view what);

}  // namespace axisgate::api
