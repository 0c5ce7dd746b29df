// The SHRC-203 as a kind of device: what server/kinds.cc lists.
#pragma once

#include "device/stage/kind.h"

namespace axisgate::shrc203 {

const stage::Kind& kind();

}  // namespace axisgate::shrc203
