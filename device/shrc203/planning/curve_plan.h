// A curve of a path as a line of EP: (manual 77) to 82)), and the motion expected from it.
#pragma once

#include <cstdint>

#include "device/core/problem.h"
#include "device/shot/command/pattern.h"
#include "device/shrc203/planning/arc.h"
#include "device/shrc203/planning/plan.h"
#include "device/shrc203/stage.h"
#include "device/stage/envelope.h"

namespace axisgate::shrc203 {

struct CurvePlan {
  Arc arc;
  CurveForm form;
  Arguments arguments;  // without speeds
};

struct PlannedCurve {
  CurvePlan curve;
  MovePlan move;  // axes in ascending order and the curve's end; relative
};

// Plans a curve that starts at `from`, and checks the whole curve against the envelope. `slack`: pulses by which the
// start may differ from `from`. Fails with invalid_request, out_of_range, outside_travel, position_unknown, or as the
// envelope's conversions do.
Result<PlannedCurve> plan_curve(const Curve& curve, bool relative, const Positions& from, std::int64_t slack,
                                const Envelope& envelope);

// Returns the number of pulses by which the end computed by the controller may differ: 1 for a curve given by an angle
// ("an error occurs", manual 72), 75)) unless it ends on whole pulses, else 0.
std::int64_t slack_of(const CurvePlan& curve);

// Returns the highest share of the path speed that an axis reaches: 1 in the plane of the circle, rise divided by
// length for the third axis.
double share_of_speed(const Arc& arc, bool third_axis);

}  // namespace axisgate::shrc203
