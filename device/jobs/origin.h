// Work origin of a job.
#pragma once

namespace axisgate::jobs {

// Position of the workpiece in mm: X and Y from the machine's home corner, Z as the distance of Z0 below the top.
struct Origin {
  double x = 0, y = 0, z = 0;
};

}  // namespace axisgate::jobs
