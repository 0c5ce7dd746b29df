// The request kind of each method.
#pragma once

#include <string>
#include <string_view>

#include "server/api/request/request_kinds.h"

namespace axisgate::rpc {

// `method` is a path such as "/axisgate.v1.StageService/Move". Returns `unlisted` for an unknown method.
api::RequestKind kind_of(std::string_view method);

// Returns the path under which gRPC serves the method. gRPC 1.51 serves reflection as v1alpha only; v1 has the same
// messages.
std::string served_as(std::string_view method);

}  // namespace axisgate::rpc
