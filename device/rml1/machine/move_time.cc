#include "device/rml1/machine/move_time.h"

#include <algorithm>
#include <cmath>

namespace axisgate::rml1 {
namespace {

// Returns the time of a trapezoidal speed profile, or of a triangular one if the distance is too short to reach the
// speed.
double rest_to_rest(double mm, double speed, double acceleration) {
  const bool reaches = speed * speed <= acceleration * mm;
  return reaches ? mm / speed + speed / acceleration : 2 * std::sqrt(mm / acceleration);
}

// Returns the length that clipping cannot leave out, in mm.
double certain_way(const Move& move, double step_mm) {
  jobs::Point way = move.to - move.from;
  way.z = std::min(move.to.z, 0.0) - std::min(move.from.z, 0.0);
  return length(way) * step_mm;
}

}  // namespace

StepTime move_time(const Move& move, const Profile& profile, bool knows_z0) {
  const double mm = length(move.to - move.from) * profile.step_mm, even = mm / move.speed;
  const double stopping = rest_to_rest(mm, move.speed, profile.acceleration.worst);
  const double slower = 1 + profile.acceleration.slower;
  const double least = knows_z0 ? even : certain_way(move, profile.step_mm) / move.speed;
  return {least, std::max(even * slower, stopping), stopping * slower};
}

StepTime wait_time(Wait what, double seconds, const Acceleration& acceleration) {
  const double most = what == Wait::turn ? seconds * (1 + acceleration.slower) : seconds;
  return {what == Wait::spin_up ? 0 : seconds, most, most};
}

StepTime dwell_between_points(double seconds) { return {0, seconds, seconds}; }

}  // namespace axisgate::rml1
