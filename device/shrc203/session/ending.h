// Whether the gateway is ending.
#pragma once

#include <optional>

#include "device/core/problem.h"

namespace axisgate::shrc203 {

// What everybody receives who comes too late; nothing before the end has begun.
using Ending = std::optional<Problem>;

}  // namespace axisgate::shrc203
