// Workpiece of a job.
#pragma once

namespace axisgate::jobs {

// Size in mm from the work origin: X to the right, Y away from the operator, Z down from Z0.
struct Stock {
  double x = 0, y = 0, z = 0;

  friend bool operator==(const Stock&, const Stock&) = default;
};

}  // namespace axisgate::jobs
