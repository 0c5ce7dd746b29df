// What a lease's holder sets for good, speeds (manual 89) D: to 92), 94) B:), outputs (96) O:) and the
// trigger (97) to 101) T:): known before, and put back when his lease has ended.
#include <string>
#include <utility>
#include <vector>

#include "device/core/guard.h"
#include "device/shrc203/controller_impl.h"
#include "device/shrc203/limits.h"
#include "device/shrc203/transaction/transaction_lines.h"

namespace axisgate::shrc203 {
namespace {

std::optional<int> outputs_of(const Command& command) {
  if (command.row->meaning != Meaning::outputs) return {};
  return static_cast<int>(*parse_integer(*command.arguments.first("s")));
}

// The S, F and R that a B: names, by its axes in their order.
std::vector<SpeedSetting> speed_settings_of(const Command& command) {
  std::vector<SpeedSetting> speeds;
  for (const auto& [letter, value] : command.arguments.values()) {
    const auto number = parse_integer(value);
    if (!number) continue;
    if (letter == "spds") speeds.push_back({*number, 0, 0});
    if (letter == "spdf" && !speeds.empty()) speeds.back().maximum = *number;
    if (letter == "r" && !speeds.empty()) speeds.back().acceleration_ms = static_cast<int>(*number);
  }
  return speeds;
}

}  // namespace

// What the lines set has to be known before, to be set back. Not D:, which learn_speeds() is for.
Task<Result<void>> Controller::Impl::learn_settings(const std::vector<Command>& commands, std::string caller) {
  Result<void> read;
  for (const Command& command : commands) {
    const AxisSet origin = axes_sped({command}, SetsSpeeds::of_origin_return, state_.controllable());
    for (int attempt = 0; attempt < kSettingReadTries; ++attempt) {
      if (outputs_of(command) && !state_.outputs) {
        read = co_await read_outputs(caller);
      } else if (trigger_of(command) && !state_.trigger) {
        read = co_await read_trigger(caller);
      } else if (known_origin_speeds(origin).size() != static_cast<std::size_t>(origin.count())) {
        read = co_await read_origin_speeds(caller);
      } else {
        break;
      }
    }
    if (!read) break;
    if (known_origin_speeds(origin).size() != static_cast<std::size_t>(origin.count())) {
      co_return fail(Reason::line_fault, "the speeds of the origin return were read as ones that no axis can have",
                     "look at them: axisctl exec ?:B");
    }
  }
  co_return read;
}

// Before it goes out. What is owed to an axis was there before what is set by now.
void Controller::Impl::remember_settings(const RequestContext& context, const Command& command) {
  if (context.lease == 0 || profile_.settings_at_lease_end == AtLeaseEnd::kept) return;
  const AxisSet axes = axes_sped({command}, SetsSpeeds::of_motion, state_.controllable()),
                origin = axes_sped({command}, SetsSpeeds::of_origin_return, state_.controllable());
  const bool outputs = outputs_of(command).has_value(), trigger = trigger_of(command).has_value();
  if (axes.empty() && origin.empty() && !outputs && !trigger) return;
  Settings& before = settings_before_[context.lease];
  for (const auto& [axis, speed] : speeds_owed_) {
    if (axes.has(axis)) before.speeds.try_emplace(axis, speed);
  }
  for (const auto& [axis, speed] : known_speeds(axes)) before.speeds.try_emplace(axis, speed);
  for (const auto& [axis, speed] : known_origin_speeds(origin)) before.origin_speeds.try_emplace(axis, speed);
  if (outputs && !before.outputs) before.outputs = state_.outputs;
  // What a scan has left armed is nobody's.
  const bool left = trigger_owed_ && state_.trigger == trigger_owed_->armed;
  if (trigger && !before.trigger) before.trigger = left ? trigger_owed_->before : state_.trigger;
  if (outputs) before.outputs_set = outputs_of(command);
  if (trigger) before.trigger_set = trigger_of(command);
  before.epoch = state_.device_epoch;
  permission_.settings_changed(context.lease);
}

// After its answer; where that was lost it may have been taken.
void Controller::Impl::note_setting(const Command& command, const ExchangeResult& result) {
  if (!result.accepted() && !result.in_doubt()) return;
  const auto outputs = outputs_of(command);
  const auto trigger = trigger_of(command);
  if (outputs) state_.outputs = result.accepted() ? outputs : std::nullopt;
  if (trigger) state_.trigger = result.accepted() ? trigger : std::nullopt;
  const AxisSet origin = axes_sped({command}, SetsSpeeds::of_origin_return, state_.controllable());
  const auto speeds = result.accepted() ? speed_settings_of(command) : std::vector<SpeedSetting>();
  std::size_t place = 0;
  for (const int axis : origin.list()) {
    note_origin_speeds(axis, place < speeds.size() ? std::optional(speeds[place]) : std::nullopt);
    ++place;
  }
  if (outputs || trigger) publish_state();
}

Task<bool> Controller::Impl::set_line_back(Command command, std::string caller) {
  ExchangeRequest request;
  request.command = command;
  request.lane = Lane::motion;
  request.caller = std::move(caller);
  request.not_after = now_ + (ending_ ? kEndRestoreWriteLimit : kStepWriteLimit);
  auto pending = line_.exchange(std::move(request), now_);
  const auto result = co_await pending;
  note_setting(command, result);
  co_return result.accepted();
}

Task<bool> Controller::Impl::set_origin_speeds_back(Speeds before, std::string caller) {
  Speeds changed;
  for (const auto& [axis, speed] : before) {
    if (state_.controllable().has(axis) && state_.axis(axis).origin_speeds != speed) changed[axis] = speed;
  }
  if (changed.empty()) co_return true;
  const bool back = co_await set_line_back(commands::set_origin_speeds(changed), std::move(caller));
  for (const auto& [axis, speed] : changed) {
    if (back) state_.axis(axis).origin_speeds = speed;
  }
  co_return back;
}

// After what may have been a restart, outputs that are off and a trigger that is none are left as they are: nothing is
// switched on in a controller that has just started.
Task<bool> Controller::Impl::set_outputs_back(Settings before, std::string caller) {
  if (!before.outputs || state_.outputs == before.outputs) co_return true;
  const bool others = state_.outputs == 0 || state_.outputs != before.outputs_set;
  if (before.epoch != state_.device_epoch && others) co_return true;
  const bool back = co_await set_line_back(commands::set_outputs(*before.outputs), std::move(caller));
  co_return back;
}

Task<bool> Controller::Impl::set_trigger_back(Settings before, std::string caller) {
  if (!before.trigger || state_.trigger == before.trigger) co_return true;
  const bool others = state_.trigger == Trigger{} || state_.trigger != before.trigger_set;
  if (before.epoch != state_.device_epoch && others) co_return true;
  const bool back = co_await set_line_back(trigger_command(*before.trigger), std::move(caller));
  co_return back;
}

// D: and T: are refused while axes move (manual 89), 97)), which somebody at the front panel may make them do; others
// have their turns meanwhile.
Task<bool> Controller::Impl::set_back_in_turn(EndedLease lease, Settings before) {
  AxisSet axes;
  for (const auto& [axis, speed] : before.speeds) axes.add(axis);
  for (const auto& [axis, speed] : before.origin_speeds) axes.add(axis);
  if (before.trigger) axes = AxisSet::all();
  if (axes.empty()) co_return true;
  // Fencing tokens are far above any motion's id.
  auto turn = gate_.enter(lease.token, axes, lease.who, TimePoint::max());
  const auto entered = co_await turn;
  if (!entered) co_return false;
  for (const auto& [axis, speed] : before.speeds) speeds_owed_.erase(axis);  // older is what was there before the lease
  ExchangeRequest request;
  request.lane = Lane::motion;
  request.caller = "the gateway on behalf of " + lease.who;
  const std::string caller = request.caller;
  const bool speeds = co_await set_back(before.speeds, std::move(request));
  const bool origin = co_await set_origin_speeds_back(before.origin_speeds, caller);
  bool trigger = co_await pay_trigger(caller);
  if (trigger) trigger = co_await set_trigger_back(before, caller);
  gate_.leave(lease.token);
  const bool back = speeds && origin && trigger;
  co_return back;
}

// The lease has ended and its axes are nobody's yet. A line that is down is waited for.
Task<void> Controller::Impl::restore_settings_of(EndedLease lease) {
  std::optional<TimePoint> give_up_at;
  while (!ending_ && guarded(Guard::settings_restored)) {
    if (line_works()) {
      const Settings before = settings_before_[lease.token];
      const bool outputs = co_await set_outputs_back(before, "the gateway on behalf of " + lease.who);
      const bool rest = co_await set_back_in_turn(lease, before);
      if (!give_up_at) give_up_at = now_ + kLeaseRestoreLimit;
      if ((outputs && rest) || now_ >= *give_up_at) break;
    } else {
      give_up_at.reset();
    }
    auto pause = tick_.wait_until(now_ + kLeaseRestorePause);
    co_await pause;
  }
  if (!ending_) settings_before_.erase(lease.token);  // the end restores by itself
  permission_.settings_restored(lease.token, now_);
}

// At the gateway's end, when nothing moves any more: no lease outlives it.
Task<void> Controller::Impl::restore_all_settings() {
  const std::string caller = "the gateway, which is ending";
  co_await pay_speeds(AxisSet::all(), caller);
  speeds_owed_.clear();
  (void)co_await pay_trigger(caller);
  for (const auto& [token, before] : std::exchange(settings_before_, {})) {
    speeds_owed_ = before.speeds;
    co_await pay_speeds(AxisSet::all(), caller);
    bool back = false;
    for (int attempt = 0; attempt < kRestoreTries && !back; ++attempt) {
      const bool origin = co_await set_origin_speeds_back(before.origin_speeds, caller);
      const bool outputs = co_await set_outputs_back(before, caller);
      const bool trigger = co_await set_trigger_back(before, caller);
      back = origin && outputs && trigger;
    }
  }
}

}  // namespace axisgate::shrc203
