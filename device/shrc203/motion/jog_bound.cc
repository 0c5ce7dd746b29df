#include "device/shrc203/motion/jog_bound.h"

#include <algorithm>
#include <chrono>

#include "device/core/guard.h"
#include "device/shrc203/limits.h"

namespace axisgate::shrc203 {
namespace {

// Number of lines between a position and the stop that follows from it, apart from a reply's whole time limit: the line
// of the position, the line ahead, ?:CMD before a stop after a silence, and the stop.
constexpr int kLines = 4;
constexpr int kLineBits = 64 * 10;

double seconds(Duration duration) { return std::chrono::duration<double>(duration).count(); }

// Returns the distance that an axis travels from `speed` until it is stationary: down to S by (F - S) / R (manual 89)).
double stopping_distance(std::int64_t speed, const AxisState& axis) {
  const auto from = static_cast<double>(speed), minimum = static_cast<double>(axis.minimum_speed.value_or(1));
  const double ramp = static_cast<double>(axis.acceleration_ms.value_or(1000)) / 1000;
  const double slope = (static_cast<double>(axis.maximum_speed.value_or(1)) - minimum) / ramp;
  if (from <= minimum) return 0;
  return slope <= 0 ? from * ramp : std::max(from * ramp, (from * from - minimum * minimum) / (2 * slope));
}

}  // namespace

std::optional<TimePoint> JogBound::stop_at(int axis) const { return stop_at(axis, live_.jog->fastest.at(axis)); }

std::optional<TimePoint> JogBound::stop_at(int axis, std::int64_t speed) const {
  const int direction = live_.jog->directions.at(axis);
  const auto bound = store_.envelope(live_.context).bound(axis, direction);
  const AxisState& state = store_.state().axis(axis);
  if (!bound || !state.position_pulses) return {};
  const double left = static_cast<double>(direction * (*bound - *state.position_pulses));
  const double free = (left - stopping_distance(speed, state)) / static_cast<double>(speed);
  const Profile& profile = store_.profile();
  const Duration reaction =
      profile.reply_limit + kJogHostDelayMax + kLines * Duration(std::chrono::seconds(kLineBits)) / profile.baud;
  const double wait = std::min(free - seconds(reaction), 3600.0);
  // The axis was stationary until its start, however old the reading is.
  const TimePoint begun = live_.jog->begun;
  const TimePoint read = begun == TimePoint{} ? now_ : std::max(store_.state().read, begun);
  return read + std::chrono::nanoseconds(static_cast<std::int64_t>(wait * 1e9));
}

std::int64_t JogBound::speed_that_fits(int axis) const {
  const std::int64_t asked = live_.jog->speeds.at(axis), present = live_.jog->fastest.at(axis);
  for (std::int64_t speed = asked; speed > present; speed /= 2) {
    const auto at = stop_at(axis, speed);
    if ((at && *at > now_) || !guarded(Guard::jog_ends_before_bound)) return speed;
  }
  return std::min(asked, present);
}

}  // namespace axisgate::shrc203
