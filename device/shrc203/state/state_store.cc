#include "device/shrc203/state/state_store.h"

#include <fmt/format.h>

#include "device/core/guard.h"
#include "device/shrc203/command/command_table.h"
#include "device/shrc203/state/pending_restores.h"

namespace axisgate::shrc203 {

void StateStore::note_trouble(LinkTrouble trouble, std::string words) {
  trouble_ = trouble;
  state_.link_problem = std::move(words);
}

void StateStore::note_wrong_panel() {
  if (state_.mode != "HOST") {
    note_trouble(LinkTrouble::mode, fmt::format("the controller is in {} mode; HOST is needed", state_.mode));
  } else {
    note_trouble(LinkTrouble::format, fmt::format("the command format is {}; SHOT_FC is needed", state_.format));
  }
}

std::string StateStore::link_problem() const {
  return state_.link_problem.empty() ? "the controller has not answered yet" : state_.link_problem;
}

Problem StateStore::not_up() const {
  return {.reason = panel_is_wrong() ? Reason::wrong_mode : Reason::link_down,
          .message = "the device is not up: " + link_problem(),
          .hint = remedy()};
}

// Another unit is accepted only if none is configured and none has been up since the daemon started.
std::string StateStore::remedy() const {
  if (panel_is_wrong()) return "correct it at the controller's front panel";
  if (trouble_ != LinkTrouble::other_unit) return "try again when it is up";
  if (!profile_.serial_number.empty()) {
    return "connect the configured unit again, or correct `serial_number` in the configuration";
  }
  if (unit_.empty()) return fmt::format("connect a controller of the model {}", model().name());
  return "connect the former unit again, or restart the daemon to accept this one";
}

void StateStore::lost() {
  ++connection_;
  settled_ = false;
  state_.outputs.reset();
  state_.trigger.reset();
  for (auto& axis : state_.axes) {
    // The busy axis may be in foreign motion.
    state_.moving_unknown = state_.moving_unknown || (axis.busy.value_or(false) && guarded(Guard::moving_unknown));
    axis.position_pulses.reset();
    axis.busy.reset();
  }
}

bool StateStore::is_expected(const Identity& identity) const {
  const std::string& serial_number = expected_unit();
  return identity.model == model().name() && (serial_number.empty() || identity.serial_number == serial_number);
}

void StateStore::identified(const Identity& identity) {
  state_.vendor = identity.vendor;
  state_.model = identity.model;
  state_.serial_number = identity.serial_number;
  state_.firmware = identity.firmware;
}

void StateStore::emit_all(const Conditions::Changes& changes) {
  for (const ConditionChanged& change : changes) emit(change);
}

void StateStore::note_mode(std::string mode) {
  state_.mode = std::move(mode);
  emit_all(conditions_.mode_read(state_.mode, tasks_.now()));
}

void StateStore::note_format(std::string format) {
  state_.format = std::move(format);
  if (!state_.format.empty()) emit_all(conditions_.format_read(state_.format, tasks_.now()));
}

void StateStore::note_excitation(const std::map<int, std::string>& fields) {
  Conditions::ByAxis off;
  for (const auto& [axis, field] : fields) {
    const bool excited = field == "1";
    state_.axis(axis).excited = excited;
    off[axis] = excited ? 0 : bit_of(stage::Condition::motor_off);
  }
  if (!off.empty()) emit_all(conditions_.motors_read(off, tasks_.now()));
}

void StateStore::note_controllable(AxisSet axes) {
  for (const int number : kAllAxes.list()) state_.axis(number).controllable = axes.has(number);
}

std::uint64_t StateStore::begin_epoch() {
  state_.epoch_began = tasks_.now();
  unit_ = state_.serial_number;
  return ++state_.device_epoch;
}

void StateStore::shift_frame(AxisSet axes) {
  ++state_.frame_epoch;
  for (const int axis : axes.list()) state_.axis(axis).homed = false;
  settled_ = false;
}

void StateStore::note_homed(AxisSet axes) {
  for (const int axis : axes.list()) {
    state_.axis(axis).homed = true;
    ++state_.axis(axis).homings;
  }
}

std::optional<StateStore::Read> StateStore::note_positions(const Reply& reply) {
  const auto readings = parse_positions(model(), reply, controllable());
  if (!readings) return std::nullopt;
  Read read;
  Conditions::ByAxis shown;
  for (const int number : kAllAxes.list()) {
    const auto& reading = (*readings)[static_cast<std::size_t>(number - 1)];
    auto& axis = state_.axis(number);
    if (!reading.valid) continue;
    axis.position_pulses = reading.pulses;
    axis.status_bits = reading.status.raw;
    axis.conditions = conditions_in(reading.status);
    axis.busy = reading.busy;
    shown[number] = axis.conditions;
    (reading.busy ? read.busy : read.ready).add(number);
  }
  state_.read = tasks_.now();
  emit_all(conditions_.status_read(shown, tasks_.now()));
  emit_all(conditions_.mode_read("HOST", tasks_.now()));
  if (read.busy.empty()) state_.moving_unknown = false;
  return read;
}

void StateStore::note_foreign_motion(AxisSet busy, AxisSet ours) {
  const AxisSet expected = state_.moving_unknown ? kAllAxes : ours | left_moving_;
  const AxisSet unasked = guarded(Guard::foreign_motion_reported) ? busy - expected : AxisSet();
  AxisSet reported;
  for (const int number : kAllAxes.list()) {
    bool& foreign = state_.axis(number).foreign_motion;
    const bool now = unasked.has(number) && (foreign || moved_unasked_.has(number));
    if (now && !foreign) reported.add(number);
    foreign = now;
  }
  moved_unasked_ = unasked;
  if (!reported.empty()) emit(ForeignMotion{reported});
}

void StateStore::note_armed(AxisSet axes, bool armed) {
  for (const int axis : axes.list()) state_.axis(axis).armed = armed;
}

void StateStore::note_speeds(const commands::Speeds& speeds) {
  for (const auto& [axis, speed] : speeds) {
    const bool possible = commands::can_be_set(speed) || !guarded(Guard::possible_speeds);
    auto& known = state_.axis(axis);
    known.minimum_speed = possible ? std::optional(speed.minimum) : std::nullopt;
    known.maximum_speed = possible ? std::optional(speed.maximum) : std::nullopt;
    known.acceleration_ms = possible ? std::optional(speed.acceleration_ms) : std::nullopt;
  }
}

void StateStore::forget_speeds(AxisSet axes) {
  for (const int axis : axes.list()) state_.axis(axis).minimum_speed = state_.axis(axis).maximum_speed = std::nullopt;
}

void StateStore::note_origin_speeds(int axis, const std::optional<SpeedSetting>& speed) {
  auto& known = state_.axis(axis).origin_speeds;
  known.reset();
  if (speed && commands::can_be_set(*speed)) known = speed;
}

commands::Speeds StateStore::speeds(AxisSet axes) const { return known_speeds(state_, axes); }
commands::Speeds StateStore::origin_speeds(AxisSet axes) const { return known_origin_speeds(state_, axes); }

}  // namespace axisgate::shrc203
