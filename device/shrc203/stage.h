// Names of the controller's family and of device/stage, made available in this namespace.
#pragma once

#include "device/shot/stage.h"

namespace axisgate::shrc203 {

using namespace shot;  // NOLINT(google-build-using-namespace)

inline constexpr int kAxisCount = 3;
inline constexpr AxisSet kAllAxes = AxisSet::first(kAxisCount);

}  // namespace axisgate::shrc203
