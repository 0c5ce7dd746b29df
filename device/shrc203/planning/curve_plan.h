// What a curve of a path comes to: a line of EP: (manual 77) to 82)), and what is to be expected of it.
#pragma once

#include <cstdint>

#include "device/core/problem.h"
#include "device/shrc203/command/pattern.h"
#include "device/shrc203/planning/plan.h"
#include "device/shrc203/stage.h"
#include "device/stage/arc.h"
#include "device/stage/envelope.h"

namespace axisgate::shrc203 {

struct CurvePlan {
  Arc arc;
  CurveForm form;
  Arguments arguments;  // without speeds
};

struct PlannedCurve {
  CurvePlan curve;
  MovePlan move;  // its axes, ascending, and where it leads; relative
};

// From where the axes are, checked against the envelope along the whole curve. invalid_request, out_of_range,
// outside_travel, position_unknown and what the envelope's conversions refuse.
// `slack`: pulses by which the axes may be off `from`.
Result<PlannedCurve> plan_curve(const Curve& curve, bool relative, const Positions& from, std::int64_t slack,
                                const Envelope& envelope);

// Pulses by which the end that the controller computes may differ: for a curve given by an angle ("an error occurs",
// manual 72), 75)), unless it ends on whole pulses.
std::int64_t slack_of(const CurvePlan& curve);

// The highest part of the path speed that each axis of the move makes on the way: 1 in the plane of the circle.
double share_of_speed(const Arc& arc, bool third_axis);

}  // namespace axisgate::shrc203
