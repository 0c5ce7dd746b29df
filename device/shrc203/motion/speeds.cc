// The speeds S, F and time R, which D: and the prebuffer settings set for good: known, and set.
#include <string>
#include <utility>

#include "device/core/guard.h"
#include "device/shrc203/controller_impl.h"
#include "device/shrc203/limits.h"

namespace axisgate::shrc203 {

// What the controller now has set by D:. The speeds given with MP:, AP: and KP: overwrite it (manual 68)). One flipped
// bit of an answer makes a speed that no D: sets, which is as good as unknown.
void Controller::Impl::note_speeds(const Speeds& speeds) {
  for (const auto& [axis, speed] : speeds) {
    const bool possible = commands::can_be_set(speed) || !guarded(Guard::possible_speeds);
    auto& known = state_.axis(axis);
    known.minimum_speed = possible ? std::optional(speed.minimum) : std::nullopt;
    known.maximum_speed = possible ? std::optional(speed.maximum) : std::nullopt;
    known.acceleration_ms = possible ? std::optional(speed.acceleration_ms) : std::nullopt;
  }
}

// Likewise of the mechanical origin return.
void Controller::Impl::note_origin_speeds(int axis, const std::optional<SpeedSetting>& speed) {
  auto& known = state_.axis(axis).origin_speeds;
  known.reset();
  if (speed && commands::can_be_set(*speed)) known = speed;
}

bool Controller::Impl::speeds_known() const {
  const AxisSet all = state_.controllable();
  return known_speeds(all).size() == static_cast<std::size_t>(all.count());
}

void Controller::Impl::forget_speeds(AxisSet axes) {
  for (const int axis : axes.list()) state_.axis(axis).minimum_speed = state_.axis(axis).maximum_speed = std::nullopt;
}

Result<MovePlan> Controller::Impl::slowed_down(AxisSet axes, const Envelope& limits) const {
  MovePlan slower;
  for (const auto& [axis, own] : known_speeds(axes)) {
    const auto cap = limits.speed_cap(axis);
    if (!cap) return tl::unexpected(cap.error());
    if (!*cap || own.maximum <= **cap) continue;
    slower.axes.push_back({axis, 0, {}, SpeedSetting{std::min(own.minimum, **cap), **cap, own.acceleration_ms}});
  }
  return slower;
}

Task<Result<void>> Controller::Impl::slow_down(LiveMotionPtr live) {
  const auto slower = slowed_down(live->motion.axes, envelope(live->context));
  if (!slower) co_return tl::unexpected(slower.error());
  if (slower->axes.empty()) co_return Result<void>();
  live->keeps_gate = true;
  const auto set = co_await set_speeds(live, *slower);
  if (set) note_speeds(speeds_of(*slower));
  co_return set;
}

// The speeds of those axes, asked for where they are not known: line_fault.
Task<Result<void>> Controller::Impl::learn_speeds(AxisSet axes, std::string caller) {
  const auto missing = [&] { return known_speeds(axes).size() < static_cast<std::size_t>(axes.count()); };
  for (int attempt = 0; attempt < kSettingReadTries && missing(); ++attempt) {
    const auto read = co_await read_speeds(caller);
    if (!read) co_return read;
  }
  if (!missing()) co_return Result<void>();
  co_return fail(Reason::line_fault, "the speeds of the axes were read as ones that no axis can have",
                 "look at them: axisctl exec ?:D; set them: axisctl exec D:...");
}

Task<Result<void>> Controller::Impl::set_speeds(LiveMotionPtr live, MovePlan plan) {
  const Command setter = commands::set_speeds(speeds_of(plan));
  auto request = motion_request(*live, setter, Lane::motion);
  auto pending = line_.exchange(std::move(request), now_);
  const auto result = co_await pending;
  if (result.accepted()) co_return Result<void>();
  if (result.problem) co_return tl::unexpected(*result.problem);
  auto why = co_await explain_refusal(setter, setter.axes(state_.controllable()), live->context.who);
  co_return tl::unexpected(std::move(why));
}

}  // namespace axisgate::shrc203
