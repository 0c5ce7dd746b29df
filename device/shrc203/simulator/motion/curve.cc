#include "device/shrc203/simulator/motion/curve.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace axisgate::shrc203::simulator {
namespace {

// Tolerance in radians: the rounding error of doubles near a multiple of pi.
constexpr double kAngleTolerance = 1e-9;

// Returns the angle ahead, above 0 and up to a whole `turn`.
double ahead(double angle, double turn) {
  double rest = std::fmod(angle, turn);
  if (rest < 0) rest += turn;
  return rest <= kAngleTolerance ? rest + turn : rest;
}

}  // namespace

std::int64_t Curve::offset(double fraction) const {
  if (fraction >= 1) return end;
  return std::llround(radius * (std::cos(phase + sweep * fraction) - std::cos(phase)));
}

// The coordinate turns back where the angle is a multiple of pi.
double Curve::turning_after(double fraction) const {
  const double angle = (phase + sweep * fraction) * (sweep < 0 ? 1 : -1);
  return fraction + ahead(angle, std::numbers::pi) / std::abs(sweep);
}

void Curve::cover(double fraction, Mileage& mileage) const {
  std::int64_t here = 0;
  for (double turning = turning_after(0); turning < fraction; turning = turning_after(turning)) {
    const std::int64_t there = offset(turning);
    mileage.add(there - here);
    here = there;
  }
  mileage.add(offset(fraction) - here);
}

std::optional<double> Curve::reaches(double level) const {
  if (radius <= 0) return std::nullopt;
  const double cosine = level / radius + std::cos(phase);
  if (std::abs(cosine) > 1) return std::nullopt;
  const double sense = sweep < 0 ? -1 : 1;
  const double to_one = ahead(sense * (std::acos(cosine) - phase), 2 * std::numbers::pi);
  const double to_other = ahead(sense * (-std::acos(cosine) - phase), 2 * std::numbers::pi);
  const double fraction = std::min(to_one, to_other) / std::abs(sweep);
  return fraction <= 1 ? std::optional(fraction) : std::nullopt;
}

std::optional<double> Curve::heads(int direction, double from) const {
  if (radius <= 0 || from >= 1) return std::nullopt;
  const double sense = sweep < 0 ? -1 : 1;
  const double slope = -std::sin(phase + sweep * from + sense * kAngleTolerance * 10) * sense;
  if ((slope > 0) == (direction > 0)) return from;
  const double turning = turning_after(from);
  return turning < 1 ? std::optional(turning) : std::nullopt;
}

}  // namespace axisgate::shrc203::simulator
