// SHRC-203 as a kind of device, for the list in server/kinds.cc.
#pragma once

#include "device/stage/kind.h"

namespace axisgate::shrc203 {

const stage::Kind& kind();

}  // namespace axisgate::shrc203
