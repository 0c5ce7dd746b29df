#include "device/rml1/simulator/travel.h"

#include <algorithm>
#include <cmath>

namespace axisgate::rml1::simulator {
namespace {

// A trapezoidal speed profile, or a triangular one if the speed is not reached.
struct Ramp {
  explicit Ramp(const Travel& travel) {
    if (travel.mm_per_s2 <= 0) {
      speed = travel.mm_per_s;
      even_s = travel.mm / speed;
      return;
    }
    speed = std::min(travel.mm_per_s, std::sqrt(travel.mm * travel.mm_per_s2));
    ramp_s = speed / travel.mm_per_s2;
    even_s = (travel.mm - speed * ramp_s) / speed;
  }

  double speed = 0, ramp_s = 0, even_s = 0;
};

}  // namespace

double Travel::seconds() const {
  if (mm <= 0) return 0;
  const Ramp ramp(*this);
  return (2 * ramp.ramp_s + ramp.even_s) * slower;
}

double Travel::part_after(double seconds_passed) const {
  const double all = seconds();
  if (seconds_passed >= all) return 1;
  const Ramp ramp(*this);
  const double passed = seconds_passed / slower;
  const double left = all / slower - passed;
  double gone = ramp.speed * (passed - ramp.ramp_s / 2);
  if (passed < ramp.ramp_s) gone = mm_per_s2 * passed * passed / 2;
  if (left < ramp.ramp_s) gone = mm - mm_per_s2 * left * left / 2;
  return std::clamp(gone / mm, 0.0, 1.0);
}

}  // namespace axisgate::rml1::simulator
