// Which kind of request each method is.
#pragma once

#include <string>
#include <string_view>

#include "server/api/request/request_kinds.h"

namespace axisgate::rpc {

// Of "/axisgate.v1.StageService/Move"; unlisted for one that is not known here.
api::RequestKind kind_of(std::string_view method);

// The name under which gRPC serves it. gRPC 1.51 knows reflection as v1alpha only; v1 has the same messages.
std::string served_as(std::string_view method);

}  // namespace axisgate::rpc
