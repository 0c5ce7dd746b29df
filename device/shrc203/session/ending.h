// State of the gateway's end.
#pragma once

#include <optional>

#include "device/core/problem.h"

namespace axisgate::shrc203 {

// Problem for all requests that come after the end has begun; nullopt before.
using Ending = std::optional<Problem>;

}  // namespace axisgate::shrc203
