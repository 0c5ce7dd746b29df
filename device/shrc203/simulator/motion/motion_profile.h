// Distance and speed of an axis along its path, from S, F and R (manual 89) D:): a pure function of time.
#pragma once

#include <cstdint>
#include <vector>

#include "device/core/time.h"

namespace axisgate::shrc203::simulator {

// S and F in pulses/s, R in ms. S <= F.
struct Speed {
  std::int64_t minimum = 0;
  std::int64_t maximum = 0;
  int ramp_ms = 0;
};

// Distances are pulses along the path, never negative; speeds are pulses/s; times are seconds since the start.
class MotionProfile {
 public:
  // Accelerates from S to F within R, runs at F, and slows down to S within R; a short path does not reach F.
  static MotionProfile trapezoid(double distance, const Speed& speed);
  static MotionProfile constant(double distance, double speed);
  // Slows down from `from_speed` to S at the rate given by R, and stops. Empty at or below S.
  static MotionProfile slowing(double from_speed, const Speed& speed);
  // Changes from `from_speed` to `to_speed` at the rate given by R, and continues at that speed; the path may end
  // earlier.
  static MotionProfile changing(double distance, double from_speed, double to_speed, const Speed& speed);

  double distance() const { return distance_; }
  Duration duration() const;  // rounded up to a whole nanosecond
  double distance_at(Duration since_start) const;
  double speed_at(Duration since_start) const;
  Duration time_at(double distance) const;  // when this distance is covered; at most duration()

 private:
  struct Section {
    double seconds;
    double start_speed;
    double acceleration;
    double length() const { return seconds * (start_speed + acceleration * seconds / 2); }
  };

  void add(double seconds, double start_speed, double acceleration);
  double seconds() const;

  std::vector<Section> sections_;
  double distance_ = 0;
};

}  // namespace axisgate::shrc203::simulator
