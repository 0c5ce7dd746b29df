// Where the parts of a picture lie.
#pragma once

#include "device/rml1/machine/bounds.h"
#include "device/rml1/picture/picture.h"

namespace axisgate::rml1 {

inline constexpr double kMargin = 52;  // pixels

// In steps.
struct Extents {
  Bounds shown;  // what the views show: each axis at least a millimetre
  std::optional<Bounds> area;
  std::optional<Bounds> stock;
};

// The three views with their scales, and beside them the work area as a whole. Nothing else yet.
Picture lay_out(const Extents& extents, double step_mm);

}  // namespace axisgate::rml1
