// The speeds S, F and time R, which D: and the prebuffer settings set for good: known, and put back.
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

Controller::Impl::Speeds Controller::Impl::known_speeds(AxisSet axes) const {
  Speeds speeds;
  for (const int number : axes.list()) {
    const auto& axis = state_.axis(number);
    if (!axis.minimum_speed || !axis.maximum_speed || !axis.acceleration_ms) continue;
    speeds[number] = {*axis.minimum_speed, *axis.maximum_speed, *axis.acceleration_ms};
  }
  return speeds;
}

Controller::Impl::Speeds Controller::Impl::known_origin_speeds(AxisSet axes) const {
  Speeds speeds;
  for (const int number : axes.list()) {
    if (const auto& known = state_.axis(number).origin_speeds) speeds[number] = *known;
  }
  return speeds;
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

// A speed is asked for one motion, but the controller keeps it (manual 68)): the next user gets back what was set
// before.
Task<void> Controller::Impl::restore_speeds(LiveMotionPtr live, Speeds before) {
  if (!live->keeps_gate) co_return;
  // What was sent last may have been taken though its answer was lost.
  if (live->motion.state != MotionState::succeeded) forget_speeds(live->motion.axes);
  auto request = motion_request(*live, {}, Lane::motion);
  request.tidies = true;
  const bool back = co_await set_back(before, std::move(request));
  if (!back) speeds_owed_.merge(before);
  leave_gate(*live);
}

// By D: for the axes whose speeds are others now. What cannot be set is read, so that the state tells what is. The
// answer tells whether the speeds are `before`.
Task<bool> Controller::Impl::set_back(Speeds before, ExchangeRequest request) {
  Speeds changed;
  for (const auto& [axis, speed] : before) {
    const Speeds now_set = known_speeds(AxisSet::of(axis));
    const bool same = !now_set.empty() && now_set.begin()->second == speed;
    if (!same && state_.controllable().has(axis)) changed[axis] = speed;
  }
  if (changed.empty()) co_return true;
  if (!line_works()) co_return false;
  request.command = commands::set_speeds(changed);
  request.not_after = now_ + (ending_ ? kEndRestoreWriteLimit : kStepWriteLimit);
  const std::string caller = request.caller;
  auto pending = line_.exchange(std::move(request), now_);
  const auto result = co_await pending;
  if (result.accepted()) {
    note_speeds(before);
    co_return true;
  }
  if (ending_) co_return false;
  const auto read = co_await read_speeds(caller);
  settled_ = settled_ && read.has_value();
  co_return false;
}

// What could not be set back when a motion ended, because the line was lost: before the next one on these axes.
Task<void> Controller::Impl::pay_speeds(AxisSet axes, std::string caller) {
  Speeds owed;
  for (const int axis : axes.list()) {
    if (auto one = speeds_owed_.extract(axis)) owed.insert(std::move(one));
  }
  bool paid = owed.empty();
  for (int attempt = 0; attempt < kRestoreTries && !paid; ++attempt) {
    ExchangeRequest request;
    request.lane = Lane::motion;
    request.caller = caller;
    paid = co_await set_back(owed, std::move(request));
  }
  if (!paid) speeds_owed_.merge(owed);
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
