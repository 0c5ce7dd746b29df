// Axes on which a jog was running when the line was lost: they are stopped as soon as a controller answers.
#pragma once

#include "device/shrc203/command/axes.h"
#include "device/shrc203/session/stops.h"

namespace axisgate::shrc203 {

class OrphanedJogs {
 public:
  explicit OrphanedJogs(Stops& stops) : stops_(stops) {}

  void add(AxisSet axes) { axes_ = axes_ | axes; }
  // Again and again, until everything was seen to be stationary.
  void stop();
  void all_stationary() { axes_ = {}; }

 private:
  Stops& stops_;
  AxisSet axes_;
};

}  // namespace axisgate::shrc203
