// Arcs and helices as lines give them (manual 71) to 82)), in pulses of their axes.
#pragma once

#include <array>

#include "device/core/problem.h"
#include "device/shrc203/command/codec.h"
#include "device/stage/arc.h"
#include "device/stage/envelope.h"

namespace axisgate::shrc203 {

// What an E: or EP: comes to.
struct ArcLine {
  Arc arc;
  std::array<int, 3> axes{};  // of ArcEnd's first, second and third; the third 0 where the curve lies in the plane
  // All that the curve may lead through. Where the direction of E:2 and E:5 does not go with their passing point, the
  // rest of the circle counts as well: the manual's own examples contradict one another (73), 76)).
  ArcExtent extent;
};

// Of a command whose register is e or ep. What the envelope's conversions refuse; invalid_request for three points on
// one line; out_of_range.
Result<ArcLine> arc_of(const Command& command, const Envelope& envelope);

// That axes of one curve have pulses of one length, which the controller does not ask: invalid_request.
Result<void> check_scales(AxisSet axes, const State& state);

}  // namespace axisgate::shrc203
