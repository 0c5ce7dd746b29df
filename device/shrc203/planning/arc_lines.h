// Arcs and helices of command lines (manual 71) to 82)), converted to pulses of their axes.
#pragma once

#include <array>

#include "device/core/problem.h"
#include "device/shot/command/command.h"
#include "device/shrc203/planning/arc.h"
#include "device/stage/envelope.h"

namespace axisgate::shrc203 {

// The curve that an E: or EP: line describes.
struct ArcLine {
  Arc arc;
  std::array<int, 3> axes{};  // axes of ArcEnd's first, second and third; third is 0 for a flat curve
  // Range that the curve may cover. If the direction of E:2 or E:5 contradicts the passing point, the rest of the
  // circle is included: the manual's own examples contradict one another (73), 76)).
  ArcExtent extent;
};

// Returns the curve of a command whose register is e or ep. Fails as the envelope's conversions do; with
// invalid_request if three points lie on one line; with out_of_range.
Result<ArcLine> arc_of(const Command& command, const Envelope& envelope);

// Checks that all axes of a curve have the same resolution, which the controller itself does not check. Fails with
// invalid_request.
Result<void> check_scales(AxisSet axes, const State& state);

}  // namespace axisgate::shrc203
