// Conversion of circles, arcs and helices from callers' messages.
#pragma once

#include "axisgate/v1/stage.pb.h"
#include "device/core/problem.h"
#include "device/stage/stage_controller.h"
#include "server/api/request/axis_names.h"

namespace axisgate::proto {

// Fails with invalid_request if a part is missing, given twice or of the wrong axes, with unknown_axis, and like
// to_quantity().
Result<stage::Curve> to_curve(const v1::Arc& arc, const api::AxisNames& names);

}  // namespace axisgate::proto
