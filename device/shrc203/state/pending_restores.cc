#include "device/shrc203/state/pending_restores.h"

#include <algorithm>
#include <set>

#include "device/shrc203/command/trigger.h"

namespace axisgate::shrc203 {
namespace {

using Value = PendingRestore::Value;

template <class Chosen>
PendingRestores::Speeds speeds_in(const std::vector<PendingRestore>& list, Chosen chosen) {
  PendingRestores::Speeds speeds;
  for (const PendingRestore& one : list) {
    if (chosen(one)) speeds[one.axis] = std::get<SpeedSetting>(one.before);
  }
  return speeds;
}

std::optional<Value> speed_at(const PendingRestores::Speeds& speeds, int axis) {
  const auto found = speeds.find(axis);
  return found == speeds.end() ? std::nullopt : std::optional<Value>(found->second);
}

// Returns the present value of the setting; nullopt if unknown.
std::optional<Value> value_now(const PendingRestore& one, const State& state) {
  switch (one.setting) {
    case RestoredSetting::speeds:
      return speed_at(known_speeds(state, AxisSet::of(one.axis)), one.axis);
    case RestoredSetting::origin_speeds:
      return state.axis(one.axis).origin_speeds;
    case RestoredSetting::outputs:
      return state.outputs;
    case RestoredSetting::trigger:
      break;
  }
  return state.trigger;
}

bool is_off(const Value& value) { return value == Value(0) || value == Value(Trigger{}); }

// Reports whether the setting is not restored: it has its old value, or its axis is not controllable. After a possible
// restart, outputs and triggers that are off stay off, since nothing is switched on in a controller that has just
// started; and a value that somebody has set meanwhile stays. Both always apply to the trigger of a scan.
bool left_as_it_is(const PendingRestore& one, const State& state) {
  const auto now = value_now(one, state);
  if (now == one.before) return true;
  if (one.axis != 0) return !state.controllable().has(one.axis);
  if (one.lease != 0 && one.epoch == state.device_epoch) return false;
  return (now && is_off(*now)) || now != one.set;
}

}  // namespace

commands::Speeds known_speeds(const State& state, AxisSet axes) {
  commands::Speeds speeds;
  for (const int number : axes.list()) {
    const auto& axis = state.axis(number);
    if (!axis.minimum_speed || !axis.maximum_speed || !axis.acceleration_ms) continue;
    speeds[number] = {*axis.minimum_speed, *axis.maximum_speed, *axis.acceleration_ms};
  }
  return speeds;
}

commands::Speeds known_origin_speeds(const State& state, AxisSet axes) {
  commands::Speeds speeds;
  for (const int number : axes.list()) {
    if (const auto& known = state.axis(number).origin_speeds) speeds[number] = *known;
  }
  return speeds;
}

PendingRestores PendingRestores::of_motion(const Speeds& before) {
  PendingRestores pending;
  for (const auto& [axis, speed] : before) pending.add({RestoredSetting::speeds, axis, 0, speed, {}, 0});
  return pending;
}

void PendingRestores::remember(std::uint64_t lease, const Change& change, const State& state) {
  const std::uint64_t epoch = state.device_epoch;
  for (PendingRestore& one : list_) {
    if (one.lease == lease) one.epoch = epoch;
  }
  const auto remember_one = [&](RestoredSetting setting, int axis, std::optional<Value> before,
                                std::optional<Value> set) {
    const bool there = find(setting, axis, lease) != nullptr;
    if (there || before) add({setting, axis, lease, before.value_or(Value()), std::move(set), epoch});
  };
  const Speeds known = known_speeds(state, change.speeds), origin = known_origin_speeds(state, change.origin_speeds);
  for (const int axis : change.speeds.list()) {
    const PendingRestore* motions = find(RestoredSetting::speeds, axis, 0);
    remember_one(RestoredSetting::speeds, axis, motions ? std::optional(motions->before) : speed_at(known, axis), {});
  }
  for (const int axis : change.origin_speeds.list()) {
    remember_one(RestoredSetting::origin_speeds, axis, speed_at(origin, axis), {});
  }
  if (change.outputs) remember_one(RestoredSetting::outputs, 0, state.outputs, change.outputs);
  if (!change.trigger) return;
  // A trigger left armed by a scan is not a caller's setting, so the trigger before the scan is restored.
  const PendingRestore* scans = find(RestoredSetting::trigger, 0, 0);
  const bool left = scans && state.trigger && scans->set == Value(*state.trigger);
  remember_one(RestoredSetting::trigger, 0, left ? std::optional(scans->before) : state.trigger, change.trigger);
}

void PendingRestores::remember_scan(const Trigger& before, const Trigger& armed) {
  add({RestoredSetting::trigger, 0, 0, before, armed, 0});
}

PendingRestores PendingRestores::take(AxisSet axes) {
  PendingRestores taken;
  for (const PendingRestore& one : list_) {
    if (one.setting == RestoredSetting::speeds && one.lease == 0 && axes.has(one.axis)) taken.add(one);
  }
  forget_speeds(axes);
  return taken;
}

void PendingRestores::keep(const PendingRestores& failed) {
  for (const PendingRestore& one : failed.list_) add(one);
}

PendingRestores PendingRestores::take_leases() {
  PendingRestores taken;
  for (const PendingRestore& one : list_) {
    if (one.lease != 0) taken.add(one);
  }
  std::erase_if(list_, [](const PendingRestore& one) { return one.lease != 0; });
  return taken;
}

PendingRestores PendingRestores::of_lease(std::uint64_t lease) const {
  PendingRestores its;
  for (const PendingRestore& one : list_) {
    if (one.lease == lease) its.add(one);
  }
  return its;
}

PendingRestores PendingRestores::of_scan() const {
  PendingRestores its;
  if (const PendingRestore* scans = find(RestoredSetting::trigger, 0, 0)) its.add(*scans);
  return its;
}

void PendingRestores::forget_speeds(AxisSet axes) {
  std::erase_if(list_, [axes](const PendingRestore& one) {
    return one.setting == RestoredSetting::speeds && one.lease == 0 && axes.has(one.axis);
  });
}

void PendingRestores::forget_scan() {
  std::erase_if(list_,
                [](const PendingRestore& one) { return one.setting == RestoredSetting::trigger && one.lease == 0; });
}

void PendingRestores::forget_lease(std::uint64_t lease) {
  std::erase_if(list_, [lease](const PendingRestore& one) { return one.lease == lease; });
}

std::vector<std::uint64_t> PendingRestores::leases() const {
  std::set<std::uint64_t> tokens;
  for (const PendingRestore& one : list_) {
    if (one.lease != 0) tokens.insert(one.lease);
  }
  return {tokens.begin(), tokens.end()};
}

PendingRestores::Speeds PendingRestores::speeds() const {
  return speeds_in(list_, [](const PendingRestore& one) { return one.setting == RestoredSetting::speeds; });
}

AxisSet PendingRestores::sped() const {
  AxisSet axes;
  for (const auto& [axis, speed] : speeds()) axes.add(axis);
  return axes;
}

AxisSet PendingRestores::stationary_axes() const {
  AxisSet axes;
  for (const PendingRestore& one : list_) {
    if (one.axis != 0) axes.add(one.axis);
    if (one.setting == RestoredSetting::trigger) axes = kAllAxes;
  }
  return axes;
}

bool PendingRestores::must_read_first(RestoredSetting setting, const State& state) const {
  return setting == RestoredSetting::trigger && has_scan() && !state.trigger;
}

std::optional<Command> PendingRestores::command(RestoredSetting setting, const State& state) const {
  const auto changed = [&](const PendingRestore& one) { return one.setting == setting && !left_as_it_is(one, state); };
  const auto first = std::ranges::find_if(list_, changed);
  if (first == list_.end()) return {};
  switch (setting) {
    case RestoredSetting::speeds:
      return commands::set_speeds(speeds_in(list_, changed));
    case RestoredSetting::origin_speeds:
      return commands::set_origin_speeds(speeds_in(list_, changed));
    case RestoredSetting::outputs:
      return commands::set_outputs(std::get<int>(first->before));
    case RestoredSetting::trigger:
      break;
  }
  return trigger_command(std::get<Trigger>(first->before));
}

const PendingRestore* PendingRestores::find(RestoredSetting setting, int axis, std::uint64_t lease) const {
  const auto found = std::ranges::find_if(list_, [&](const PendingRestore& one) {
    return one.setting == setting && one.axis == axis && one.lease == lease;
  });
  return found == list_.end() ? nullptr : &*found;
}

// Adds the entry. An existing entry keeps its old value to restore and takes over the newest value that was set.
void PendingRestores::add(const PendingRestore& one) {
  const auto found = std::ranges::find_if(list_, [&](const PendingRestore& other) {
    return other.setting == one.setting && other.axis == one.axis && other.lease == one.lease;
  });
  if (found == list_.end()) {
    list_.push_back(one);
  } else if (one.set) {
    found->set = one.set;
  }
}

}  // namespace axisgate::shrc203
