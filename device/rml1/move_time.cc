#include "device/rml1/move_time.h"

#include <algorithm>
#include <cmath>

namespace axisgate::rml1 {
namespace {

// A trapezoid, or a triangle where the way is too short for the speed.
double rest_to_rest(double mm, double speed, double acceleration) {
  const bool reaches = speed * speed <= acceleration * mm;
  return reaches ? mm / speed + speed / acceleration : 2 * std::sqrt(mm / acceleration);
}

}  // namespace

StepTime move_time(double mm, double speed, const Acceleration& acceleration) {
  const double least = mm / speed, stopping = rest_to_rest(mm, speed, acceleration.worst);
  const double slower = 1 + acceleration.slower;
  return {least, std::max(least * slower, stopping), stopping * slower};
}

StepTime wait_time(Wait what, double seconds, const Acceleration& acceleration) {
  const double most = what == Wait::turn ? seconds * (1 + acceleration.slower) : seconds;
  return {what == Wait::spin_up ? 0 : seconds, most, most};
}

StepTime dwell_between_points(double seconds) { return {0, seconds, seconds}; }

}  // namespace axisgate::rml1
