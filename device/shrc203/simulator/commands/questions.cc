#include "device/shrc203/simulator/commands/questions.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "device/shrc203/simulator/commands/memory_switch_commands.h"
#include "device/shrc203/simulator/commands/program_commands.h"

namespace axisgate::shrc203::simulator {
namespace {

std::string digit(bool on) { return on ? "1" : "0"; }

// Manual 32): off, read, or not readable.
std::string config_status(const Axis& axis) {
  return axis.configured && axis.flags.has(AxisFlag::config) ? "E" : digit(axis.configured);
}

std::string speed_text(const Speed& speed) {
  return fmt::format("S{}F{}R{}", speed.minimum, speed.maximum, speed.ramp_ms);
}

// One answer for the whole controller.
struct PlainQuestion {
  std::string_view name;
  std::string (*answer)(const Rig& rig);
};

constexpr std::array kPlain = {
    PlainQuestion{"V", [](const Rig& rig) { return rig.options.firmware; }},
    PlainQuestion{"N", [](const Rig&) { return std::string("SHRC-203"); }},
    PlainQuestion{"SN", [](const Rig& rig) { return rig.serial_number; }},
    PlainQuestion{"AXIS", [](const Rig& rig) { return std::to_string(rig.axis_setting); }},
    PlainQuestion{"MODE", [](const Rig& rig) { return rig.mode; }},
    PlainQuestion{"FMT", [](const Rig& rig) { return std::string(rig.hit_format ? "HIT" : "SHOT_FC"); }},
    // NS if nothing was sent since power-on, as for the other ?: questions.
    PlainQuestion{"CMD", [](const Rig& rig) { return rig.previous_line.empty() ? "NS" : rig.previous_line; }},
    PlainQuestion{"O", [](const Rig& rig) { return std::to_string(rig.outputs); }},
    PlainQuestion{"W", [](const Rig& rig) { return std::to_string(rig.motions.wait_tenths); }},
    PlainQuestion{"SLEEP", [](const Rig& rig) { return digit(rig.sleeping); }},
    PlainQuestion{"BO", [](const Rig& rig) { return digit(rig.lights); }},
    PlainQuestion{"BEEP", [](const Rig& rig) { return digit(rig.beep); }},
    PlainQuestion{"L", program_status},
    PlainQuestion{"T", [](const Rig& rig) { return rig.triggers.describe(); }},
};

// One field for each named axis.
struct AxisQuestion {
  std::string_view name;
  std::string (*field)(const Rig& rig, int axis);
};

constexpr std::array kByAxis = {
    // Scale resolution of a stage whose pulse is one count of its scale (manual 9)).
    AxisQuestion{"R", [](const Rig& r, int axis) { return from_pulses(1, 'N', r.axis(axis).pitch()); }},
    AxisQuestion{"P", [](const Rig& r, int axis) { return from_pulses(1, 'N', r.axis(axis).pitch()); }},
    AxisQuestion{"S", [](const Rig& r, int axis) { return std::to_string(r.axis(axis).divide()); }},
    AxisQuestion{"AN", [](const Rig& r, int axis) { return std::string(1, r.axis(axis).name); }},
    AxisQuestion{"D", [](const Rig& r, int axis) { return speed_text(r.axis(axis).speed); }},
    AxisQuestion{"DR", [](const Rig& r, int axis) { return std::to_string(r.axis(axis).speed.ramp_ms); }},
    AxisQuestion{"B", [](const Rig& r, int axis) { return speed_text(r.axis(axis).origin_speed); }},
    AxisQuestion{"ACS", [](const Rig& r, int axis) { return config_status(r.axis(axis)); }},
    AxisQuestion{"C", [](const Rig& r, int axis) { return digit(r.axis(axis).excited); }},
    AxisQuestion{"F", [](const Rig& r, int axis) { return digit(r.axis(axis).open_loop); }},
};

// ?:DS and ?:DF (manual 14), 15)): the unit may follow the axis.
std::optional<std::string> answer_one_speed(const Rig& rig, bool minimum, Reader reader) {
  const auto axes = reader.rest().starts_with(',') ? rig.controllable : reader.take_axes_or_all(rig.controllable);
  if (!axes) return std::nullopt;
  char unit = 'F';
  if (reader.take(',')) {
    if (reader.rest().size() != 1 || std::string_view("FNUMD").find(reader.rest()[0]) == std::string_view::npos) {
      return std::nullopt;
    }
    unit = reader.rest()[0];
    reader.take(unit);
  }
  if (!reader.done()) return std::nullopt;
  return join_fields(*axes, [&](int axis) {
    const Speed& speed = rig.axis(axis).speed;
    return from_pulses(minimum ? speed.minimum : speed.maximum, unit, rig.axis(axis).pitch());
  });
}

std::optional<std::string> answer_setting(const Rig& rig, std::string_view body) {
  for (const PlainQuestion& question : kPlain) {
    if (body == question.name) return question.answer(rig);
  }
  for (const AxisQuestion& question : kByAxis) {
    Reader reader(body);
    if (!reader.take_text(question.name)) continue;
    const auto axes = reader.take_axes_or_all(rig.controllable);
    if (!axes || !reader.done()) continue;
    return join_fields(*axes, [&](int axis) { return question.field(rig, axis); });
  }
  for (const std::string_view name : {"DS", "DF"}) {
    if (!body.starts_with(name)) continue;
    if (auto text = answer_one_speed(rig, name == "DS", Reader(body.substr(name.size())))) return text;
  }
  for (const std::string_view name : {"MP", "M", "AP", "A", "EP", "E", "KP", "K", "WT", "WI", "J"}) {
    if (!body.starts_with(name)) continue;
    if (auto text = answer_register(rig, name, Reader(body.substr(name.size())))) return text;
  }
  return std::nullopt;
}

}  // namespace

bool is_question(std::string_view line) {
  return line.starts_with('?') || line.starts_with('!') || line.starts_with("Q:") || line.starts_with("SRQ:") ||
         line == "*IDN?" || line == "I:" || line == "BEEP?" || line.starts_with("PIT:GET") ||
         line.starts_with("PAV:GET") || is_memory_switch_question(line) || asks_for_program_line(line);
}

std::optional<std::string> answer(const Rig& rig, std::string_view line) {
  if (line == "*IDN?") {
    return fmt::format("SIGMAKOKI,SHRC-203,{},{}", rig.serial_number, rig.options.firmware);
  }
  if (line == "I:") return std::to_string(rig.inputs);
  if (line.starts_with("PIT:") || line.starts_with("PAV:")) return answer_saved_position(rig, line);
  // Manual 31), 32), 39) write these three commands differently in one place.
  if (line == "BEEP?") return answer_setting(rig, "BEEP");
  if (line.starts_with("?J:")) return answer_setting(rig, fmt::format("J{}", line.substr(3)));
  if (line.starts_with("?ACS")) return answer_setting(rig, line.substr(1));
  if (is_memory_switch_question(line)) return answer_memory_switch(rig, line);
  if (asks_for_program_line(line)) return answer_program_line(rig, line);
  if (line.starts_with("?:")) return answer_setting(rig, line.substr(2));
  return answer_status(rig, line);
}

}  // namespace axisgate::shrc203::simulator
