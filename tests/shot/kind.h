// Kinds of device for SHOT-1, SHOT-2 and SHOT-8. A real kind would be one line in server/kinds.cc.
#pragma once

#include "device/stage/kind.h"

namespace axisgate::shot2 {

const stage::Kind& kind_of(int axis_count);  // 1, 2 or 8

}  // namespace axisgate::shot2
