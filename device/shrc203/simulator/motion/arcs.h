// The curves of E:0 to E:5 and EP:0 to EP:5 (manual 71) to 82)) as paths: a circle of two axes, and for a helix the
// third axis with them.
#pragma once

#include <array>
#include <cstdint>

#include "device/shrc203/simulator/buffer.h"
#include "device/shrc203/simulator/motion/curve.h"

namespace axisgate::shrc203::simulator {

struct ArcPath {
  std::array<Curve, 2> plane;  // curves of the axis with the smaller number, and of the other axis
  bool helical = false;
  std::int64_t linear = 0;  // displacement of the third axis over the whole curve, pulses
  double length = 0;        // length of the whole curve, pulses
};

// Returns the path. Must not be called for three points on one line, which the manual refuses.
ArcPath path_of(const Arc& arc);

}  // namespace axisgate::shrc203::simulator
