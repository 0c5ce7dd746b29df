// Extent of a job, as displayed to people.
#pragma once

#include <string>

#include "device/jobs/bounds.h"

namespace axisgate::jobs {

// Bounds in mm from the work origin and from Z0; Z grows upward.
struct Extent {
  Bounds driven, cut;

  // Adds another part of the job.
  void take(const Extent& other);
  // Depth of the deepest cut; 0 if nothing is cut.
  double deepest() const { return cut.z.any ? -cut.z.lowest : 0; }
};

// Returns the extent of the same job with steps that are `factor` times as long.
Extent scaled(const Extent& extent, double factor);

// Returns "38.0 x 30.0 mm, 1.70 mm deep", or "cuts nothing".
std::string size_text(const Extent& extent);

}  // namespace axisgate::jobs
