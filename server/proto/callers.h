// Callers as messages of the API.
#pragma once

#include <string_view>

#include "axisgate/v1/common.pb.h"

namespace axisgate::proto {

// Returns the caller with this name (Caller::who).
v1::Caller to_caller(std::string_view who);

}  // namespace axisgate::proto
