// Layout of the parts of a picture.
#pragma once

#include "device/jobs/bounds.h"
#include "device/rml1/picture/picture.h"

namespace axisgate::rml1 {

inline constexpr double kMargin = 52;  // pixels

// Bounds in steps.
struct Extents {
  jobs::Bounds shown;  // range of the views: each axis at least a millimetre
  std::optional<jobs::Bounds> area;
  std::optional<jobs::Bounds> stock;
};

// Returns the three views with their scales, and beside them the whole work area, without any strokes.
Picture lay_out(const Extents& extents, double step_mm);

}  // namespace axisgate::rml1
