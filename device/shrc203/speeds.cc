// The speeds S, F and time R, which D: and the prebuffer settings set for good: known, and put back.
#include <string>
#include <utility>

#include "device/core/guard.h"
#include "device/shrc203/controller_impl.h"

namespace axisgate::shrc203 {
namespace {

constexpr int kSetBackTries = 3;
// D: is refused while the axes move (manual 89)), which somebody at the front panel may make them do.
constexpr int kRestoreTries = 100;
constexpr Duration kRestorePause = std::chrono::milliseconds(100);

}  // namespace

// What the controller now has set by D:. The speeds given with MP:, AP: and KP: overwrite it (manual 68)). One flipped
// bit of an answer makes a speed that no D: sets, which is as good as unknown.
void Controller::Impl::note_speeds(const Speeds& speeds) {
  for (const auto& [axis, speed] : speeds) {
    Arguments setting;
    setting.axes(AxisSet::of(axis)).speeds(speed.minimum, speed.maximum, speed.acceleration_ms);
    const bool possible = encode(command_row("D:"), setting).has_value() || !guarded(Guard::possible_speeds);
    auto& known = state_.axis(axis);
    known.minimum_speed = possible ? std::optional(speed.minimum) : std::nullopt;
    known.maximum_speed = possible ? std::optional(speed.maximum) : std::nullopt;
    known.acceleration_ms = possible ? std::optional(speed.acceleration_ms) : std::nullopt;
  }
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

// A speed is asked for one motion, but the controller keeps it (manual 68)): the next user gets back what was set
// before.
Task<void> Controller::Impl::restore_speeds(LiveMotionPtr live, Speeds before) {
  if (!live->keeps_gate) co_return;
  auto request = motion_request(*live, {}, Lane::motion);
  request.tidies = true;
  const bool back = co_await set_back(before, std::move(request));
  if (!back) speeds_owed_.merge(before);
  leave_gate(*live);
}

// By D: for the axes whose speeds are others now. What cannot be set is read, so that the state tells what is. The
// answer tells whether the speeds are `before`.
Task<bool> Controller::Impl::set_back(Speeds before, ExchangeRequest request) {
  AxisSet axes;
  for (const auto& [axis, speed] : before) axes.add(axis);
  const Speeds now_set = known_speeds(axes);
  AxisSet changed;
  for (const auto& [axis, speed] : before) {
    const auto found = now_set.find(axis);
    if (found == now_set.end() || !(found->second == speed)) changed.add(axis);
  }
  if (changed.empty()) co_return true;
  if (state_.link == LinkState::down) co_return false;
  Arguments arguments;
  arguments.axes(changed);
  for (const int axis : changed.list()) {
    arguments.speeds(before[axis].minimum, before[axis].maximum, before[axis].acceleration_ms);
  }
  request.command = make_command("D:", arguments);
  request.not_after = now_ + kStepLimit;
  const std::string caller = request.caller;
  auto pending = line_.exchange(std::move(request), now_);
  const auto result = co_await pending;
  if (result.accepted()) {
    note_speeds(before);
    co_return true;
  }
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
  for (int attempt = 0; attempt < kSetBackTries && !owed.empty(); ++attempt) {
    ExchangeRequest request;
    request.lane = Lane::motion;
    request.caller = caller;
    const bool back = co_await set_back(owed, std::move(request));
    if (back) break;
  }
}

// Before a D: of a lease's holder goes out.
void Controller::Impl::remember_speeds(const RequestContext& context, AxisSet axes) {
  if (context.lease == 0 || profile_.speeds_at_lease_end == AtLeaseEnd::kept) return;
  auto& before = speeds_before_[context.lease];
  for (const auto& [axis, speed] : known_speeds(axes)) before.try_emplace(axis, speed);
  permission_.settings_changed(context.lease);
}

// The lease has ended and its axes are nobody's yet. A line that is down is waited for.
Task<void> Controller::Impl::restore_speeds_of(EndedLease lease) {
  AxisSet axes;
  for (const auto& [axis, speed] : speeds_before_[lease.token]) axes.add(axis);
  // Fencing tokens are far above any motion's id.
  auto turn = gate_.enter(lease.token, axes, lease.who, TimePoint::max());
  const auto entered = co_await turn;
  for (int attempt = 0; entered && attempt < kRestoreTries && guarded(Guard::speeds_restored);) {
    const auto before = speeds_before_.find(lease.token);
    if (before == speeds_before_.end() || ending_) break;
    if (state_.link == LinkState::up || state_.link == LinkState::doubtful) {
      ExchangeRequest request;
      request.lane = Lane::motion;
      request.caller = "the gateway on behalf of " + lease.who;
      const bool restored = co_await set_back(before->second, std::move(request));
      if (restored) break;
      ++attempt;
    }
    auto pause = tick_.wait_until(now_ + kRestorePause);
    co_await pause;
  }
  if (!ending_) speeds_before_.erase(lease.token);  // the end restores by itself
  if (entered) gate_.leave(lease.token);
  permission_.settings_restored(lease.token, now_);
}

// At the gateway's end, when nothing moves any more: no lease outlives it.
Task<void> Controller::Impl::restore_all_speeds() {
  co_await pay_speeds(AxisSet::all(), "the gateway, which is ending");
  for (const auto& [token, before] : std::exchange(speeds_before_, {})) {
    ExchangeRequest request;
    request.lane = Lane::motion;
    request.caller = "the gateway, which is ending";
    (void)co_await set_back(before, std::move(request));
  }
}

Task<Result<void>> Controller::Impl::set_speeds(LiveMotionPtr live, MovePlan plan) {
  Arguments arguments;
  AxisSet axes;
  for (const auto& axis : plan.axes) {
    if (axis.speed) axes.add(axis.axis);
  }
  arguments.axes(axes);
  for (const auto& axis : plan.axes) {
    if (axis.speed) arguments.speeds(axis.speed->minimum, axis.speed->maximum, axis.speed->acceleration_ms);
  }
  auto request = motion_request(*live, make_command("D:", arguments), Lane::motion);
  auto pending = line_.exchange(std::move(request), now_);
  const auto result = co_await pending;
  if (result.accepted()) co_return Result<void>();
  if (result.problem) co_return tl::unexpected(*result.problem);
  auto why = co_await explain_refusal("D:", axes, live->context.who);
  co_return tl::unexpected(std::move(why));
}

}  // namespace axisgate::shrc203
