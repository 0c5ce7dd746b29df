// How far along its path an axis is, and how fast, from S, F and R (manual 89) D:): a pure function of time.
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

// Distances are pulses along the path, never negative; speeds pulses/s; times seconds since the start.
class MotionProfile {
 public:
  // From S up to F within R, on at F, and down to S within R; a short path turns round below F.
  static MotionProfile trapezoid(double distance, const Speed& speed);
  static MotionProfile constant(double distance, double speed);
  // From `from_speed` down to S as steeply as R says, and then stationary. Empty at or below S.
  static MotionProfile slowing(double from_speed, const Speed& speed);
  // From `from_speed` up or down to `to_speed` as steeply as R says, and on at that; it may end before.
  static MotionProfile changing(double distance, double from_speed, double to_speed, const Speed& speed);

  double distance() const { return distance_; }
  Duration duration() const;  // rounded up to a whole nanosecond
  double distance_at(Duration since_start) const;
  double speed_at(Duration since_start) const;
  Duration time_at(double distance) const;  // when that far; at most duration()

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
