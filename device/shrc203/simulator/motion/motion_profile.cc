#include "device/shrc203/simulator/motion/motion_profile.h"

#include <algorithm>
#include <cmath>

namespace axisgate::shrc203::simulator {
namespace {

double to_seconds(Duration duration) { return std::chrono::duration<double>(duration).count(); }

// Rounds up to a whole nanosecond, but ignores the rounding errors of double arithmetic.
Duration round_up(double seconds) { return Duration(static_cast<std::int64_t>(std::ceil(seconds * 1e9 - 1e-3))); }

double slope(const Speed& speed) {
  return static_cast<double>(speed.maximum - speed.minimum) / (static_cast<double>(speed.ramp_ms) / 1000.0);
}

// Returns the seconds needed to cover `length`, starting at `start_speed`.
double seconds_for(double length, double start_speed, double acceleration) {
  if (acceleration == 0) return length / start_speed;
  const double square = std::max(0.0, start_speed * start_speed + 2 * acceleration * length);
  return (std::sqrt(square) - start_speed) / acceleration;
}

}  // namespace

MotionProfile MotionProfile::trapezoid(double distance, const Speed& speed) {
  if (speed.minimum == speed.maximum || speed.ramp_ms == 0) {
    return constant(distance, static_cast<double>(speed.maximum));
  }
  const double start = static_cast<double>(speed.minimum);
  const double top = static_cast<double>(speed.maximum);
  const double acceleration = slope(speed);
  const double ramp_length = (top * top - start * start) / (2 * acceleration);
  MotionProfile profile;
  profile.distance_ = distance;
  if (distance >= 2 * ramp_length) {
    const double ramp = (top - start) / acceleration;
    profile.add(ramp, start, acceleration);
    profile.add((distance - 2 * ramp_length) / top, top, 0);
    profile.add(ramp, top, -acceleration);
  } else {
    const double peak = std::sqrt(start * start + acceleration * distance);
    const double ramp = (peak - start) / acceleration;
    profile.add(ramp, start, acceleration);
    profile.add(ramp, peak, -acceleration);
  }
  return profile;
}

MotionProfile MotionProfile::constant(double distance, double speed) {
  MotionProfile profile;
  profile.distance_ = distance;
  profile.add(distance / speed, speed, 0);
  return profile;
}

MotionProfile MotionProfile::slowing(double from_speed, const Speed& speed) {
  MotionProfile profile;
  const double end = static_cast<double>(speed.minimum);
  if (from_speed <= end || speed.minimum == speed.maximum || speed.ramp_ms == 0) return profile;
  const double deceleration = slope(speed);
  profile.add((from_speed - end) / deceleration, from_speed, -deceleration);
  profile.distance_ = profile.sections_.front().length();
  return profile;
}

MotionProfile MotionProfile::changing(double distance, double from_speed, double to_speed, const Speed& speed) {
  if (speed.minimum == speed.maximum || speed.ramp_ms == 0) return constant(distance, to_speed);
  const double acceleration = to_speed < from_speed ? -slope(speed) : slope(speed);
  const double ramp_length = (to_speed * to_speed - from_speed * from_speed) / (2 * acceleration);
  MotionProfile profile;
  profile.distance_ = distance;
  profile.add(seconds_for(std::min(ramp_length, distance), from_speed, acceleration), from_speed, acceleration);
  if (ramp_length < distance) profile.add((distance - ramp_length) / to_speed, to_speed, 0);
  return profile;
}

void MotionProfile::add(double seconds, double start_speed, double acceleration) {
  sections_.push_back({seconds, start_speed, acceleration});
}

double MotionProfile::seconds() const {
  double total = 0;
  for (const Section& section : sections_) total += section.seconds;
  return total;
}

Duration MotionProfile::duration() const { return round_up(seconds()); }

double MotionProfile::distance_at(Duration since_start) const {
  double rest = to_seconds(since_start);
  if (rest >= seconds()) return distance_;
  double covered = 0;
  for (const Section& section : sections_) {
    if (rest < section.seconds) {
      return std::clamp(covered + rest * (section.start_speed + section.acceleration * rest / 2), 0.0, distance_);
    }
    covered += section.length();
    rest -= section.seconds;
  }
  return distance_;
}

double MotionProfile::speed_at(Duration since_start) const {
  double rest = to_seconds(since_start);
  for (const Section& section : sections_) {
    if (rest < section.seconds) return section.start_speed + section.acceleration * rest;
    rest -= section.seconds;
  }
  return 0;
}

Duration MotionProfile::time_at(double distance) const {
  double elapsed = 0;
  double rest = distance;
  for (const Section& section : sections_) {
    if (rest < section.length()) {
      elapsed += seconds_for(rest, section.start_speed, section.acceleration);
      return std::min(round_up(elapsed), duration());
    }
    rest -= section.length();
    elapsed += section.seconds;
  }
  return duration();
}

}  // namespace axisgate::shrc203::simulator
