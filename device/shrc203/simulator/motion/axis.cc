#include "device/shrc203/simulator/motion/axis.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace axisgate::shrc203::simulator {
namespace {

// Distance from the origin sensor at which the fast part of an origin return ends and the approach at S begins, in
// pulses.
constexpr std::int64_t kOriginClearance = 1000;

// Fraction of a pulse by which it may be early and still counts as made; time has whole nanoseconds.
constexpr double kPulseTolerance = 1e-3;

int sign_of(std::int64_t amount) { return amount < 0 ? -1 : 1; }

}  // namespace

Axis::Axis(const AxisSetup& setup) : setup_(setup), base_nanometers_e6_(setup.nm_per_pulse_e6 * kDefaultDivide) {
  power_on(TimePoint{});
}

void Axis::power_on(TimePoint now) {
  stand_at(place_at(now), now);
  rest();
  set_divide(kDefaultDivide);
  zero_ = mechanical_zero_ = place_;
  speed = {setup_.minimum_speed, setup_.maximum_speed, setup_.acceleration_ms};
  origin_speed = {setup_.origin_minimum_speed, setup_.origin_maximum_speed, setup_.origin_acceleration_ms};
  excited = true;
  open_loop = true;
  emergency = limit_error = false;
  errors.set(AxisError::overflow, false);
}

void Axis::preset(std::int64_t coordinate) { zero_ = mechanical_zero_ = place_ - coordinate; }
void Axis::set_logical_origin() { zero_ = place_; }
void Axis::clear_logical_origin() { zero_ = mechanical_zero_; }
void Axis::set_mechanical_origin() { zero_ = mechanical_zero_ = place_; }

void Axis::set_divide(std::int64_t divide) {
  const std::int64_t shown = place_ - zero_;
  const std::int64_t shift = zero_ - mechanical_zero_;
  place_ = place_ * divide / divide_;
  zero_ = place_ - shown;
  mechanical_zero_ = zero_ - shift;
  divide_ = divide;
}

std::int64_t Axis::in_pulses(std::int64_t setup_pulses) const { return setup_pulses * divide_ / kDefaultDivide; }

bool Axis::limit_sensor(int direction, TimePoint now) const {
  if (direction > 0) return forced_plus_ || place_at(now) >= in_pulses(setup_.travel_plus_pulses);
  return forced_minus_ || place_at(now) <= in_pulses(setup_.travel_minus_pulses);
}

bool Axis::origin_sensor(TimePoint now) const { return place_at(now) == in_pulses(setup_.origin_pulses); }

void Axis::force_limit(int direction, bool on, TimePoint now) {
  (direction > 0 ? forced_plus_ : forced_minus_) = on;
  if (phase_ == Phase::moving && leg_.curve) {
    watch_limits(now);
    return;
  }
  if (!on || phase_ != Phase::moving || leg_.amount == 0 || sign_of(leg_.amount) != sign_of(direction)) return;
  halt(now);
  leg_meets_limit_ = true;
}

std::int64_t Axis::room(int direction) const {
  if (direction > 0) return forced_plus_ ? 0 : std::max<std::int64_t>(0, in_pulses(setup_.travel_plus_pulses) - place_);
  return forced_minus_ ? 0 : std::max<std::int64_t>(0, place_ - in_pulses(setup_.travel_minus_pulses));
}

std::int64_t Axis::place_at(TimePoint now) const {
  if (phase_ == Phase::moving && leg_.curve) return place_ + leg_.curve->offset(fraction_at(now));
  if (phase_ != Phase::moving || leg_.amount == 0) return place_;
  const double covered = leg_.begun + leg_.path.distance_at(now - leg_.start) * leg_.pulses_per_unit();
  const auto made = static_cast<std::int64_t>(std::floor(covered + kPulseTolerance));
  return place_ + sign_of(leg_.amount) * std::clamp<std::int64_t>(made, 0, std::abs(leg_.amount));
}

Mileage Axis::mileage(TimePoint now) const {
  Mileage gone = mileage_;
  if (phase_ == Phase::moving && leg_.curve) {
    leg_.curve->cover(fraction_at(now), gone);
  } else {
    gone.add(place_at(now) - place_);
  }
  return gone;
}

void Axis::stand_at(std::int64_t place, TimePoint now) {
  mileage_ = mileage(now);
  mileage_.add(place - place_at(now));
  place_ = place;
}

double Axis::fraction_at(TimePoint now) const {
  const double whole = leg_.path.distance();
  return whole <= 0 ? 1 : leg_.path.distance_at(now - leg_.start) / whole;
}

double Axis::Leg::pulses_per_unit() const {
  if (path.distance() <= 0) return 0;
  return (static_cast<double>(std::abs(amount)) - begun) / path.distance();
}

void Axis::start_leg(MotionProfile path, std::int64_t amount, const Speed& slope, TimePoint now) {
  const std::int64_t whole = std::abs(amount);
  const std::int64_t free = room(sign_of(amount));
  leg_meets_limit_ = amount != 0 && whole >= free;
  Duration length = amount == 0 ? Duration::zero() : path.duration();
  if (leg_meets_limit_) {
    length = path.time_at(path.distance() * static_cast<double>(free) / static_cast<double>(whole));
  }
  leg_ = {std::move(path), amount, now, slope, 0, {}};
  phase_ = Phase::moving;
  event_ = now + length;
}

void Axis::move(std::int64_t amount, TimePoint now) {
  stepped_ = amount != 0;
  start_leg(MotionProfile::trapezoid(static_cast<double>(std::abs(amount)), speed), amount, speed, now);
}

void Axis::follow(std::int64_t amount, const MotionProfile& path, TimePoint now) {
  stepped_ = path.distance() > 0;
  start_leg(path, amount, speed, now);
  if (amount == 0) event_ = now + path.duration();
}

void Axis::follow(const Curve& curve, const MotionProfile& path, TimePoint now) {
  stepped_ = path.distance() > 0;
  leg_ = {path, curve.end, now, speed, 0, curve};
  phase_ = Phase::moving;
  watch_limits(now);
}

// A curve may turn back and meet either sensor; the first sensor that it meets ends it.
void Axis::watch_limits(TimePoint now) {
  leg_meets_limit_ = false;
  event_ = leg_.start + leg_.path.duration();
  for (const int direction : {1, -1}) {
    const bool forced = direction > 0 ? forced_plus_ : forced_minus_;
    const std::int64_t free = room(direction);
    const double half_before = direction * (static_cast<double>(std::max<std::int64_t>(free, 1)) - 0.5);
    const auto met = forced ? leg_.curve->heads(direction, fraction_at(now)) : leg_.curve->reaches(half_before);
    if (!met) continue;
    const TimePoint when = std::max(now, leg_.start + leg_.path.time_at(leg_.path.distance() * *met));
    if (leg_meets_limit_ && when >= *event_) continue;
    leg_meets_limit_ = true;
    event_ = when;
    curve_limit_ = forced ? leg_.curve->offset(*met) : direction * free;
  }
}

void Axis::jog(int direction, TimePoint now) {
  stepped_ = true;
  const std::int64_t free = room(direction);
  start_leg(MotionProfile::constant(static_cast<double>(free), static_cast<double>(speed.minimum)),
            direction * std::max<std::int64_t>(free, 1), speed, now);
}

// The unfinished pulse continues in the new leg, so no pulse is lost however often the speed changes.
void Axis::change_jog(std::int64_t to_speed, TimePoint now) {
  const Duration elapsed = now - leg_.start;
  const std::int64_t here = place_at(now);
  const double begun = leg_.begun + leg_.path.distance_at(elapsed) - static_cast<double>(std::abs(here - place_));
  const int direction = sign_of(leg_.amount);
  const std::int64_t left = std::abs(place_ + leg_.amount - here);
  if (left == 0) return;
  const Speed slope = leg_.slope;
  MotionProfile path = MotionProfile::changing(static_cast<double>(left) - begun, leg_.path.speed_at(elapsed),
                                               static_cast<double>(to_speed), slope);
  stand_at(here, now);
  start_leg(std::move(path), direction * left, slope, now);
  leg_.begun = begun;
}

void Axis::return_to_origin(TimePoint now) {
  stepped_ = true;
  const std::int64_t origin = in_pulses(setup_.origin_pulses);
  const std::int64_t clear =
      std::clamp<std::int64_t>(in_pulses(setup_.travel_plus_pulses) - origin - 1, 0, kOriginClearance);
  const std::int64_t amount = origin + clear - place_;
  start_leg(MotionProfile::trapezoid(static_cast<double>(std::abs(amount)), origin_speed), amount, origin_speed, now);
  creep_to_ = origin;
}

void Axis::wait(std::optional<TimePoint> until) {
  stepped_ = false;
  phase_ = Phase::waiting;
  event_ = until;
}

void Axis::decelerate(TimePoint now) {
  if (leg_.curve) {  // an arc runs at S
    halt(now);
    return;
  }
  const double path_speed = leg_.path.speed_at(now - leg_.start);
  MotionProfile path = MotionProfile::slowing(path_speed * leg_.pulses_per_unit(), leg_.slope);
  const Speed slope = leg_.slope;
  const int sign = sign_of(leg_.amount);
  const std::int64_t left = std::abs(place_ + leg_.amount - place_at(now));
  halt(now);
  const auto amount = std::min(static_cast<std::int64_t>(std::llround(path.distance())), left);
  if (amount > 0) start_leg(std::move(path), sign * amount, slope, now);
}

void Axis::halt(TimePoint now) {
  stand_at(place_at(now), now);
  creep_to_.reset();
  leg_ = Leg{};
  leg_meets_limit_ = false;
  phase_ = Phase::moving;
  event_ = now;
}

Axis::LegEnd Axis::end_leg(TimePoint now) {
  const int direction = sign_of(leg_.amount);
  if (leg_meets_limit_) {
    if (leg_.curve) {
      stand_at(place_ + curve_limit_, now);
    } else if (leg_.amount != 0) {
      stand_at(place_ + direction * room(direction), now);
    }
    leg_ = Leg{};
    creep_to_.reset();
    limit_error = true;
    return LegEnd::limit;
  }
  stand_at(place_ + leg_.amount, now);
  leg_ = Leg{};
  if (!creep_to_) return LegEnd::target;
  const std::int64_t amount = *creep_to_ - place_;
  creep_to_.reset();
  start_leg(MotionProfile::constant(static_cast<double>(std::abs(amount)), static_cast<double>(origin_speed.minimum)),
            amount, origin_speed, now);
  return LegEnd::next_leg;
}

void Axis::settle(TimePoint until) {
  phase_ = Phase::settling;
  event_ = until;
}

void Axis::rest() {
  phase_ = Phase::idle;
  leg_ = Leg{};
  creep_to_.reset();
  event_.reset();
}

}  // namespace axisgate::shrc203::simulator
