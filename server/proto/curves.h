// Circles, arcs and helices as callers write them, as a controller takes them.
#pragma once

#include "axisgate/v1/stage.pb.h"
#include "device/core/problem.h"
#include "device/stage/stage_controller.h"

namespace axisgate::proto {

// invalid_request where something is missing, doubled or of the wrong axes, unknown_axis; of an amount as
// to_quantity().
Result<stage::Curve> to_curve(const v1::Arc& arc);

}  // namespace axisgate::proto
