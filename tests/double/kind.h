// Kind of device for the rotor. A real kind would be one line in server/kinds.cc.
#pragma once

#include "device/stage/kind.h"

namespace axisgate::rotor {

const stage::Kind& kind();

}  // namespace axisgate::rotor
