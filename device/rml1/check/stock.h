// The workpiece of a job.
#pragma once

namespace axisgate::rml1 {

// In mm, from the work origin: X and Y to the right and away, Z down from Z0.
struct Stock {
  double x = 0, y = 0, z = 0;

  friend bool operator==(const Stock&, const Stock&) = default;
};

}  // namespace axisgate::rml1
