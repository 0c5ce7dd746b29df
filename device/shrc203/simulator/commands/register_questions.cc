#include <fmt/format.h>

#include "device/shrc203/simulator/commands/questions.h"

namespace axisgate::shrc203::simulator {
namespace {

constexpr std::string_view kNotSet = "NS";

struct Register {
  std::string_view name;
  Kind kind;
  bool prebuffer;
};

constexpr std::array kRegistersByAxis = {
    Register{"M", Kind::relative, false}, Register{"MP", Kind::relative, true},  Register{"A", Kind::absolute, false},
    Register{"AP", Kind::absolute, true}, Register{"WT", Kind::wait_time, true}, Register{"WI", Kind::wait_input, true},
    Register{"J", Kind::jog, false},
};

// Registers of lines and arcs: one for the whole controller.
constexpr std::array kWhole = {
    Register{"K", Kind::line, false},
    Register{"KP", Kind::line, true},
    Register{"E", Kind::arc, false},
    Register{"EP", Kind::arc, true},
};

bool has_unit(Kind kind) { return kind == Kind::relative || kind == Kind::absolute; }

// Reads the `,u` at the end; pulses if there is none.
std::optional<char> take_unit(Reader& reader) {
  if (reader.done()) return 'P';
  if (!reader.take(',')) return std::nullopt;
  for (const char unit : {'P', 'N', 'U', 'M', 'D'}) {
    if (reader.take(unit)) return reader.done() ? std::optional(unit) : std::nullopt;
  }
  return std::nullopt;
}

std::string field_of(const Rig& rig, const Register& asked, int axis, char unit) {
  const Setting* setting =
      asked.prebuffer ? rig.motions.prebuffer().find(asked.kind, axis) : rig.motions.execution(asked.kind, axis);
  if (setting == nullptr) return std::string(kNotSet);
  const std::int64_t value = setting->values[index_of(axis)];
  if (asked.kind == Kind::jog) return value < 0 ? "-" : "+";
  return has_unit(asked.kind) ? from_pulses(value, unit, rig.axis(axis).pitch()) : std::to_string(value);
}

std::string line_text(const Rig& rig, const Setting& setting, char unit) {
  return fmt::format("{},{}", letter_of(setting.axes), join_fields(setting.axes, [&](int axis) {
                       return from_pulses(setting.values[index_of(axis)], unit, rig.axis(axis).pitch());
                     }));
}

// Manual 22) ?:E: shape, axes, direction, turns, points, angle, linear movement; each shape has only some of these.
std::string arc_text(const Rig& rig, const Setting& setting, char unit) {
  const Arc& arc = *setting.arc;
  std::string text = fmt::format("{},{},{}", arc.shape, setting.letter, arc.direction);
  if (arc.turns) text += fmt::format(",{}", *arc.turns);
  const auto axes = setting.axes.list();
  const std::size_t in_plane = arc.points.size() - arc.points.size() % 2;
  for (std::size_t i = 0; i < in_plane; ++i) {
    text += ',' + from_pulses(arc.points[i], unit, rig.axis(axes[i % 2]).pitch());
  }
  if (arc.angle) text += ',' + to_text(*arc.angle);
  if (in_plane < arc.points.size()) text += ',' + from_pulses(arc.points.back(), unit, rig.axis(axes.back()).pitch());
  return text;
}

}  // namespace

std::optional<std::string> answer_register(const Rig& rig, std::string_view name, Reader arguments) {
  for (const Register& asked : kRegistersByAxis) {
    if (asked.name != name) continue;
    const bool all = arguments.done() || arguments.rest().starts_with(',');
    const auto axes = all ? rig.controllable : arguments.take_axes(rig.controllable);
    if (!axes || (!has_unit(asked.kind) && !arguments.done())) return std::nullopt;
    const auto unit = take_unit(arguments);
    if (!unit) return std::nullopt;
    return join_fields(*axes, [&](int axis) { return field_of(rig, asked, axis, *unit); });
  }
  for (const Register& asked : kWhole) {
    if (asked.name != name) continue;
    const auto unit = take_unit(arguments);
    if (!unit) return std::nullopt;
    const Setting* setting =
        asked.prebuffer ? rig.motions.prebuffer().find(asked.kind) : rig.motions.execution(asked.kind);
    if (setting == nullptr) return std::string(kNotSet);
    return asked.kind == Kind::line ? line_text(rig, *setting, *unit) : arc_text(rig, *setting, *unit);
  }
  return std::nullopt;
}

}  // namespace axisgate::shrc203::simulator
