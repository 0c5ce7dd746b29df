// Measured pace of a machine.
#pragma once

namespace axisgate::jobs {

// Range of the time that the machine needs, as a multiple of the time that the slowest machine of its profile needs.
struct MeasuredPace {
  double least = 0, most = 0;

  friend bool operator==(const MeasuredPace&, const MeasuredPace&) = default;
};

}  // namespace axisgate::jobs
