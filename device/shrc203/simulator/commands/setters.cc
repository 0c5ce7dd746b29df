#include "device/shrc203/simulator/commands/setters.h"

#include <algorithm>
#include <array>

namespace axisgate::shrc203::simulator {
namespace {

constexpr std::string_view kLengthUnits = "PNUMD";
constexpr std::string_view kSpeedUnits = "FNUMD";

constexpr std::array kDivisions = {1,  2,   3,   4,   5,   6,   8,   10,  12,  20,  25,   30,   40,   50,  60,
                                   80, 100, 120, 125, 200, 250, 300, 400, 600, 800, 1000, 2000, 4000, 8000};

constexpr std::array<std::string_view, 7> kModes = {"HOST", "MANUAL", "REMOTE", "TEACHING", "EDIT", "LOAD", "TEST"};

bool all_free(const Rig& rig) { return !rig.motions.busy(rig.controllable) && !rig.program.run.active(); }

// Switches one flag of the whole controller to 0 or 1; NG while anything is BUSY.
Answer switch_flag(Rig& rig, Reader reader, bool Rig::*flag) {
  const auto value = reader.take_digit(1);
  if (!value || !reader.done() || !all_free(rig)) return Answer::ng;
  rig.*flag = *value == 1;
  return Answer::ok;
}

Answer sleep(Rig& rig, Reader reader) { return switch_flag(rig, reader, &Rig::sleeping); }
Answer light(Rig& rig, Reader reader) { return switch_flag(rig, reader, &Rig::lights); }
Answer beep(Rig& rig, Reader reader) { return switch_flag(rig, reader, &Rig::beep); }

Answer reset(Rig&, Reader reader) { return answer_if(reader.done()); }

// Manual 49) writes TEACHING as TEACH in its text.
Answer change_mode(Rig& rig, Reader reader) {
  const std::string_view wanted = reader.rest() == "TEACH" ? "TEACHING" : reader.rest();
  const auto mode = std::find(kModes.begin(), kModes.end(), wanted);
  if (mode == kModes.end() || !all_free(rig)) return Answer::ng;
  rig.mode = *mode;
  return Answer::ok;
}

Answer change_format(Rig& rig, Reader reader) {
  const bool hit = reader.rest() == "HIT";
  if ((!hit && reader.rest() != "SHOT_FC") || !all_free(rig)) return Answer::ng;
  rig.hit_format = hit;
  return Answer::ok;
}

Answer wait_before_ready(Rig& rig, Reader reader) {
  const auto tenths = reader.take_integer(0, 2550);
  if (!tenths || !reader.done() || !all_free(rig)) return Answer::ng;
  rig.motions.wait_tenths = static_cast<int>(*tenths);
  return Answer::ok;
}

Answer outputs(Rig& rig, Reader reader) {
  const auto pattern = reader.take_integer(0, 63);
  if (!pattern || !reader.done()) return Answer::ng;
  rig.outputs = static_cast<int>(*pattern);
  return Answer::ok;
}

// F: and C: give all named axes the same value (manual 51), 52)).
Answer switch_axes(Rig& rig, Reader reader, bool Axis::*flag) {
  const auto axes = reader.take_axes(rig.controllable);
  const auto value = reader.take_digit(1);
  if (!axes || !value || !reader.done() || !rig.is_free(*axes)) return Answer::ng;
  for (const int axis : axes->list()) rig.axis(axis).*flag = *value == 1;
  return Answer::ok;
}

Answer loop(Rig& rig, Reader reader) { return switch_axes(rig, reader, &Axis::open_loop); }
Answer excite(Rig& rig, Reader reader) { return switch_axes(rig, reader, &Axis::excited); }

Answer clear_errors(Rig& rig, Reader reader) {
  const auto axes = reader.take_axes_or_all(rig.controllable);
  if (!axes || !reader.done()) return Answer::ng;
  for (const int number : axes->list()) {
    Axis& axis = rig.axis(number);
    axis.emergency = axis.limit_error = false;
    axis.errors.set(AxisError::overflow, false);
  }
  rig.motions.release(*axes, rig.now);
  return Answer::ok;
}

// Reads one value for each axis with `take(axis)`, with or without a comma between them, up to the end of the line.
template <class Value, class Take>
std::optional<std::array<Value, kAxes>> take_each(Reader& reader, const Axes& axes, Take take) {
  std::array<Value, kAxes> values{};
  bool first = true;
  for (const int axis : axes.list()) {
    if (!first) reader.take(',');
    first = false;
    const std::optional<Value> value = take(axis);
    if (!value) return std::nullopt;
    values[index_of(axis)] = *value;
  }
  if (!reader.done()) return std::nullopt;
  return values;
}

Answer preset(Rig& rig, Reader reader) {
  const auto axes = reader.take_axes(rig.controllable);
  if (!axes || !rig.is_free(*axes)) return Answer::ng;
  const auto values = take_each<std::int64_t>(reader, *axes, [&](int axis) -> std::optional<std::int64_t> {
    const auto amount = reader.take_amount(kLengthUnits);
    const auto pulses = amount ? rig.to_pulses(amount->number, amount->unit, axis) : std::nullopt;
    return pulses && *pulses <= kCoordinateMax && *pulses >= -kCoordinateMax ? pulses : std::nullopt;
  });
  if (!values) return Answer::ng;
  for (const int axis : axes->list()) rig.axis(axis).preset((*values)[index_of(axis)]);
  return Answer::ok;
}

Answer divide(Rig& rig, Reader reader) {
  const auto axes = reader.take_axes(rig.controllable);
  if (!axes || !reader.take(',') || !rig.is_free(*axes)) return Answer::ng;
  const auto values = take_each<std::int64_t>(reader, *axes, [&](int) { return reader.take_integer(1, 8000); });
  if (!values) return Answer::ng;
  for (const int axis : axes->list()) {
    if (!is_division((*values)[index_of(axis)]) || rig.axis(axis).configured) return Answer::ng;
  }
  for (const int axis : axes->list()) rig.axis(axis).set_divide((*values)[index_of(axis)]);
  return Answer::ok;
}

// Manual 89) refuses D: only when BUSY; a real unit was observed to refuse it without excitation as well.
bool may_set_speed(const Rig& rig, const Axes& axes) {
  return rig.is_free(axes) && (rig.options.is("speed_when_unexcited", "accepted") || rig.is_excited(axes));
}

Answer speeds(Rig& rig, Reader reader, Speed Axis::*target) {
  const auto axes = reader.take_axes(rig.controllable);
  if (!axes || !may_set_speed(rig, *axes)) return Answer::ng;
  const auto values = take_each<Speed>(reader, *axes, [&](int axis) { return take_speed(rig, reader, 'P', axis); });
  if (!values) return Answer::ng;
  for (const int axis : axes->list()) rig.axis(axis).*target = (*values)[index_of(axis)];
  return Answer::ok;
}

Answer move_speeds(Rig& rig, Reader reader) { return speeds(rig, reader, &Axis::speed); }
Answer origin_speeds(Rig& rig, Reader reader) { return speeds(rig, reader, &Axis::origin_speed); }

// Reads one speed with its own unit (manual 90), 91), 93)).
std::optional<std::int64_t> take_speed_with_unit(const Rig& rig, Reader& reader, int axis) {
  const auto amount = reader.take_amount(kSpeedUnits);
  const auto pulses = amount ? rig.to_pulses(amount->number, amount->unit, axis) : std::nullopt;
  return pulses && *pulses >= 1 && *pulses <= kSpeedMax ? pulses : std::nullopt;
}

Answer one_speed(Rig& rig, Reader reader, std::int64_t Speed::*part) {
  const auto axes = reader.take_axes(rig.controllable);
  if (!axes || !may_set_speed(rig, *axes)) return Answer::ng;
  const auto values = take_each<Speed>(reader, *axes, [&](int axis) -> std::optional<Speed> {
    const auto pulses = take_speed_with_unit(rig, reader, axis);
    if (!pulses) return std::nullopt;
    Speed speed = rig.axis(axis).speed;
    speed.*part = *pulses;
    return speed.minimum <= speed.maximum ? std::optional(speed) : std::nullopt;
  });
  if (!values) return Answer::ng;
  for (const int axis : axes->list()) rig.axis(axis).speed = (*values)[index_of(axis)];
  return Answer::ok;
}

Answer minimum_speed(Rig& rig, Reader reader) { return one_speed(rig, reader, &Speed::minimum); }
Answer maximum_speed(Rig& rig, Reader reader) { return one_speed(rig, reader, &Speed::maximum); }

Answer ramp(Rig& rig, Reader reader) {
  const auto axes = reader.take_axes(rig.controllable);
  if (!axes || !may_set_speed(rig, *axes)) return Answer::ng;
  const auto values = take_each<std::int64_t>(reader, *axes, [&](int) { return reader.take_integer(1, kRampMax); });
  if (!values) return Answer::ng;
  for (const int axis : axes->list()) rig.axis(axis).speed.ramp_ms = static_cast<int>((*values)[index_of(axis)]);
  return Answer::ok;
}

// Manual 93): accepted only while J: drives every named axis.
Answer jog_speed(Rig& rig, Reader reader) {
  const auto axes = reader.take_axes(rig.controllable);
  if (!axes || !rig.motions.jogging(*axes)) return Answer::ng;
  const auto values =
      take_each<std::int64_t>(reader, *axes, [&](int axis) { return take_speed_with_unit(rig, reader, axis); });
  if (!values) return Answer::ng;
  for (const int axis : axes->list()) rig.motions.override_jog(axis, (*values)[index_of(axis)], rig.now);
  return Answer::ok;
}

constexpr std::array kSetters = {
    Command{"RESET:", reset},
    Command{"SLEEP:", sleep},
    Command{"BO:", light},
    Command{"BEEP:", beep},
    Command{"MODE:", change_mode},
    Command{"FMT:", change_format},
    Command{"W:", wait_before_ready},
    Command{"O:", outputs},
    Command{"F:", loop},
    Command{"C:", excite},
    Command{"BEC:", clear_errors},
    Command{"PSET:", preset},
    Command{"S:", divide},
    Command{"D:", move_speeds},
    Command{"B:", origin_speeds},
    Command{"DS:", minimum_speed},
    Command{"DF:", maximum_speed},
    Command{"DR:", ramp},
    Command{"JD:", jog_speed},
};

}  // namespace

bool is_division(std::int64_t division) {
  return std::find(kDivisions.begin(), kDivisions.end(), division) != kDivisions.end();
}

std::optional<Speed> take_speed(const Rig& rig, Reader& reader, char unit, int axis) {
  const auto take_part = [&](char letter) -> std::optional<std::int64_t> {
    const auto number = reader.take(letter) ? reader.take_number() : std::nullopt;
    const auto pulses = number ? rig.to_pulses(*number, unit, axis) : std::nullopt;
    return pulses && *pulses >= 1 && *pulses <= kSpeedMax ? pulses : std::nullopt;
  };
  const auto minimum = take_part('S');
  const auto maximum = minimum ? take_part('F') : std::nullopt;
  if (!maximum || *minimum > *maximum || !reader.take('R')) return std::nullopt;
  const auto ramp_ms = reader.take_integer(1, kRampMax);
  if (!ramp_ms) return std::nullopt;
  return Speed{*minimum, *maximum, static_cast<int>(*ramp_ms)};
}

const Command* find_controller_command(std::string_view verb) {
  const auto found =
      std::find_if(kSetters.begin(), kSetters.end(), [&](const Command& command) { return command.verb == verb; });
  return found == kSetters.end() ? nullptr : &*found;
}

Answer execute(Rig& rig, std::string_view line) {
  const auto colon = line.find(':');
  const std::string_view verb = colon == std::string_view::npos ? line : line.substr(0, colon + 1);
  const Reader arguments(colon == std::string_view::npos ? std::string_view{} : line.substr(colon + 1));
  for (const auto find : {find_controller_command, find_motion_command, find_buffer_command, find_trigger_command,
                          find_saved_position_command, find_memory_switch_command, find_program_command}) {
    if (const Command* command = find(verb)) return command->run(rig, arguments);
  }
  return Answer::ng;
}

}  // namespace axisgate::shrc203::simulator
