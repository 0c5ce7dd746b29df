// What E:0 to E:5 and EP:0 to EP:5 (manual 71) to 82)) mean as a path: a circle of two axes, and the third with them.
#pragma once

#include <array>
#include <cstdint>

#include "device/shrc203/simulator/buffer.h"
#include "device/shrc203/simulator/motion/curve.h"

namespace axisgate::shrc203::simulator {

struct ArcPath {
  std::array<Curve, 2> plane;  // of the axis with the smaller number, and of the other
  bool helical = false;
  std::int64_t linear = 0;  // what the third axis goes meanwhile, pulses
  double length = 0;        // of all of it together, pulses
};

// Not of three points on one line, which the manual refuses.
ArcPath path_of(const Arc& arc);

}  // namespace axisgate::shrc203::simulator
