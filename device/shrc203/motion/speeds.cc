#include "device/shrc203/motion/speeds.h"

#include <algorithm>
#include <utility>

namespace axisgate::shrc203 {

Result<MovePlan> MotionSpeeds::slowed_down(AxisSet axes, const Envelope& limits) const {
  MovePlan slower;
  for (const auto& [axis, own] : store_.speeds(axes)) {
    const auto cap = limits.speed_cap(axis);
    if (!cap) return tl::unexpected(cap.error());
    if (!*cap || own.maximum <= **cap) continue;
    slower.axes.push_back({axis, 0, {}, SpeedSetting{std::min(own.minimum, **cap), **cap, own.acceleration_ms}});
  }
  return slower;
}

Task<Result<void>> MotionSpeeds::slow_down(LiveMotionPtr live) {
  const auto slower = slowed_down(live->motion.axes, store_.envelope(live->context));
  if (!slower) co_return tl::unexpected(slower.error());
  if (slower->axes.empty()) co_return Result<void>();
  live->speeds_before = store_.speeds(live->motion.axes);
  const auto lowered = co_await set(live, *slower);
  if (lowered) store_.note_speeds(speeds_of(*slower));
  co_return lowered;
}

Task<Result<void>> MotionSpeeds::set(LiveMotionPtr live, MovePlan plan) {
  const Command setter = commands::set_speeds(speeds_of(plan));
  auto pending = dialogue_.exchange(dialogue_.request_of(*live, setter, Lane::motion));
  const auto result = co_await pending;
  if (result.accepted()) co_return Result<void>();
  if (result.problem) co_return tl::unexpected(*result.problem);
  auto why = co_await explainer_.explain(setter, setter.axes(store_.controllable()), live->context.who);
  co_return tl::unexpected(std::move(why));
}

}  // namespace axisgate::shrc203
