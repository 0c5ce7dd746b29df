// Kind of device for the SHOT-2. A real kind would be one line in server/kinds.cc.
#pragma once

#include "device/stage/kind.h"

namespace axisgate::shot2 {

const stage::Kind& kind();

}  // namespace axisgate::shot2
