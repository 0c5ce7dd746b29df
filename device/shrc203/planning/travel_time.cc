#include "device/shrc203/planning/travel_time.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace axisgate::shrc203 {
namespace {

double seconds_of(double way, const SpeedSetting& speed) {
  const auto minimum = static_cast<double>(speed.minimum), maximum = static_cast<double>(speed.maximum);
  const double ramp = static_cast<double>(speed.acceleration_ms) / 1000;
  const double both_ramps = (minimum + maximum) * ramp;
  if (way >= both_ramps) return 2 * ramp + (way - both_ramps) / maximum;
  const double acceleration = (maximum - minimum) / ramp;
  if (acceleration == 0) return way / maximum;
  return 2 * (std::sqrt(minimum * minimum + acceleration * way) - minimum) / acceleration;
}

}  // namespace

Duration travel_time(double way, const SpeedSetting& speed) {
  return std::chrono::nanoseconds(static_cast<std::int64_t>(seconds_of(way, speed) * 1e9));
}

std::optional<Duration> travel_time(const MovePlan& move, const Positions& from,
                                    const std::map<int, SpeedSetting>& known) {
  Duration longest{};
  for (const AxisPlan& one : move.axes) {
    const auto begin = from[static_cast<std::size_t>(one.axis - 1)];
    const auto own = known.find(one.axis);
    if (!one.target || !begin || (!one.speed && own == known.end())) return std::nullopt;
    const auto way = static_cast<double>(std::abs(*one.target - *begin));
    longest = std::max(longest, travel_time(way, one.speed ? *one.speed : own->second));
  }
  return longest;
}

}  // namespace axisgate::shrc203
