// SHOT-2: an invented controller of two axes in SHOT/FC mode, to try what its family shares.
#pragma once

#include "device/shot/command/model.h"

namespace axisgate::shot2 {

using namespace shot;  // NOLINT(google-build-using-namespace)

const Model& model();

}  // namespace axisgate::shot2
