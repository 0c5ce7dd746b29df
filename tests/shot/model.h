// Invented controllers in SHOT/FC mode, SHOT-1, SHOT-2 and SHOT-8 by the number of their axes, to try what the family
// shares.
#pragma once

#include "device/shot/command/model.h"

namespace axisgate::shot2 {

using namespace shot;  // NOLINT(google-build-using-namespace)

const Model& model_of(int axis_count);  // 1, 2 or 8

}  // namespace axisgate::shot2
