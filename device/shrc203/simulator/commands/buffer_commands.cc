#include <algorithm>
#include <array>
#include <utility>

#include "device/shrc203/simulator/commands/setters.h"

namespace axisgate::shrc203::simulator {
namespace {

constexpr std::int64_t kAmountMax = 999'999'999;  // pulses
constexpr std::string_view kUnits = "PNUMD";
constexpr std::string_view kUnitsWithoutDegrees = "PNUM";

std::optional<std::int64_t> in_range(std::optional<std::int64_t> pulses) {
  return pulses && *pulses <= kAmountMax && *pulses >= -kAmountMax ? pulses : std::nullopt;
}

bool limit_seen(const Rig& rig, const Axes& axes) {
  const auto list = axes.list();
  return std::any_of(list.begin(), list.end(), [&](int axis) { return rig.axis(axis).any_limit_sensor(rig.now); });
}

// The execution buffer answers NG when BUSY or not excited, the prebuffer only when not excited (manual 67), 68)).
Answer store(Rig& rig, Setting setting, bool prebuffer) {
  if (!rig.can_move(setting.axes)) return Answer::ng;
  if (setting.indivisible() && limit_seen(rig, setting.axes)) return Answer::ng;
  if (prebuffer) {
    const auto accepted = rig.motions.set_prebuffer(setting);
    if (accepted == Motions::Accepted::no) return Answer::ng;
    return accepted == Motions::Accepted::chained ? Answer::ok_d : Answer::ok;
  }
  if (!rig.is_free(setting.axes)) return Answer::ng;
  rig.motions.set_execution(std::move(setting));
  return Answer::ok;
}

// Reads one amount for each axis of the setting, in order; the units are kept for the speeds that follow.
bool take_amounts(const Rig& rig, Reader& reader, std::string_view units, Setting& setting,
                  std::array<char, kAxes>& unit_of) {
  for (const int axis : setting.axes.list()) {
    const auto amount = reader.take_amount(units);
    const auto pulses = amount ? in_range(rig.to_pulses(amount->number, amount->unit, axis)) : std::nullopt;
    if (!pulses) return false;
    setting.values[index_of(axis)] = *pulses;
    unit_of[index_of(axis)] = amount->unit;
  }
  return true;
}

// Reads the `,SspdsFspdfRr` of the given axes, each in the unit of its amount (manual 68)); all of it may be missing.
bool take_speeds(const Rig& rig, Reader& reader, const std::vector<int>& axes, Setting& setting,
                 const std::array<char, kAxes>& unit_of) {
  if (reader.done()) return true;
  for (const int axis : axes) {
    reader.take(',');
    const auto speed = take_speed(rig, reader, unit_of[index_of(axis)], axis);
    if (!speed) return false;
    setting.speeds[index_of(axis)] = speed;
  }
  return reader.done();
}

Answer set_move(Rig& rig, Reader reader, Kind kind, bool prebuffer) {
  const auto axes = reader.take_axes(rig.controllable);
  if (!axes) return Answer::ng;
  Setting setting;
  setting.kind = kind;
  setting.axes = *axes;
  std::array<char, kAxes> unit_of{};
  if (!take_amounts(rig, reader, kUnits, setting, unit_of)) return Answer::ng;
  const bool complete = prebuffer ? take_speeds(rig, reader, setting.axes.list(), setting, unit_of) : reader.done();
  return complete ? store(rig, std::move(setting), prebuffer) : Answer::ng;
}

Answer relative(Rig& rig, Reader reader) { return set_move(rig, reader, Kind::relative, false); }
Answer relative_next(Rig& rig, Reader reader) { return set_move(rig, reader, Kind::relative, true); }
Answer absolute(Rig& rig, Reader reader) { return set_move(rig, reader, Kind::absolute, false); }
Answer absolute_next(Rig& rig, Reader reader) { return set_move(rig, reader, Kind::absolute, true); }

// Two or three axes by their own letters; W is not allowed (manual 71), 83)).
std::optional<Axes> take_plane(const Rig& rig, Reader& reader, std::string_view letters) {
  if (reader.done() || letters.find(reader.rest().front()) == std::string_view::npos) return std::nullopt;
  return reader.take_axes(rig.controllable);
}

Answer set_line(Rig& rig, Reader reader, bool prebuffer) {
  const auto axes = take_plane(rig, reader, "ABCD");
  if (!axes) return Answer::ng;
  Setting setting;
  setting.kind = Kind::line;
  setting.axes = *axes;
  std::array<char, kAxes> unit_of{};
  if (!take_amounts(rig, reader, prebuffer ? kUnits : kUnitsWithoutDegrees, setting, unit_of)) return Answer::ng;
  const bool complete = prebuffer ? take_speeds(rig, reader, {axes->lowest()}, setting, unit_of) : reader.done();
  return complete ? store(rig, std::move(setting), prebuffer) : Answer::ng;
}

Answer line(Rig& rig, Reader reader) { return set_line(rig, reader, false); }
Answer line_next(Rig& rig, Reader reader) { return set_line(rig, reader, true); }

// Parts of each of E:0 to E:5 (manual 71) to 76)).
struct ArcShape {
  bool turns;
  int pairs;  // of coordinates in the plane
  std::int64_t angle_max;
  bool helical;
};

constexpr std::array kShapes = {ArcShape{false, 1, 0, false},      ArcShape{false, 1, 360, false},
                                ArcShape{false, 2, 0, false},      ArcShape{true, 1, 0, true},
                                ArcShape{false, 1, 360'000, true}, ArcShape{false, 2, 0, true}};

// Reads degrees, more than 0.
std::optional<Number> take_angle(Reader& reader, std::int64_t highest) {
  const auto angle = reader.take('D') ? reader.take_number() : std::nullopt;
  if (!angle || angle->digits == 0) return std::nullopt;
  std::int64_t limit = highest;
  for (int i = 0; i < angle->decimals; ++i) limit *= 10;
  return angle->digits <= limit ? angle : std::nullopt;
}

bool take_arc(const Rig& rig, Reader& reader, Setting& setting, std::array<char, kAxes>& unit_of) {
  Arc& arc = *setting.arc;
  const ArcShape& shape = kShapes[static_cast<std::size_t>(arc.shape)];
  const auto plane = setting.axes.list();
  const auto take_point = [&](int axis) {
    const auto amount = reader.take_amount(kUnitsWithoutDegrees);
    const auto pulses = amount ? in_range(rig.to_pulses(amount->number, amount->unit, axis)) : std::nullopt;
    if (!pulses) return false;
    arc.points.push_back(*pulses);
    if (unit_of[index_of(axis)] == 0) unit_of[index_of(axis)] = amount->unit;
    return true;
  };
  if (shape.turns) {
    const auto turns = reader.take('N') ? reader.take_integer(1, 1000) : std::nullopt;
    if (!turns) return false;
    arc.turns = static_cast<int>(*turns);
  }
  for (int i = 0; i < shape.pairs * 2; ++i) {
    if (!take_point(plane[static_cast<std::size_t>(i % 2)])) return false;
  }
  if (shape.angle_max > 0) {
    arc.angle = take_angle(reader, shape.angle_max);
    if (!arc.angle) return false;
  }
  if (shape.helical) return take_point(3);
  return true;
}

// Three points on a straight line do not form an arc (manual 73), 79)).
bool is_straight(const Arc& arc) {
  if (arc.points.size() < 4) return false;
  const auto& p = arc.points;
  return p[0] * p[3] == p[1] * p[2];
}

Answer set_arc(Rig& rig, Reader reader, bool prebuffer) {
  Setting setting;
  setting.kind = Kind::arc;
  const auto shape = reader.take_digit(5);
  if (!shape) return Answer::ng;
  const bool helical = kShapes[static_cast<std::size_t>(*shape)].helical;
  setting.letter = reader.done() ? ' ' : reader.rest().front();
  const auto axes = take_plane(rig, reader, helical ? "A" : "ABC");
  const auto direction = axes ? reader.take_digit(1) : std::nullopt;
  if (!direction || (helical && !rig.controllable.has(3))) return Answer::ng;
  setting.axes = *axes;
  setting.arc = Arc{*shape, *direction, {}, {}, {}};
  std::array<char, kAxes> unit_of{};
  if (!take_arc(rig, reader, setting, unit_of) || is_straight(*setting.arc)) return Answer::ng;
  const bool complete = prebuffer ? take_speeds(rig, reader, {axes->lowest()}, setting, unit_of) : reader.done();
  if (helical) setting.axes.add(3);
  return complete ? store(rig, std::move(setting), prebuffer) : Answer::ng;
}

Answer arc(Rig& rig, Reader reader) { return set_arc(rig, reader, false); }
Answer arc_next(Rig& rig, Reader reader) { return set_arc(rig, reader, true); }

Answer jog(Rig& rig, Reader reader) {
  const auto axes = reader.take_axes(rig.controllable);
  if (!axes) return Answer::ng;
  Setting setting;
  setting.kind = Kind::jog;
  setting.axes = *axes;
  for (const int axis : axes->list()) setting.values[index_of(axis)] = reader.take_sign();
  return reader.done() ? store(rig, std::move(setting), false) : Answer::ng;
}

// WT:a,0 and WI:a,C end a running wait (manual 57), 58)); section 2 writes WT:a,C.
bool is_cancel(std::string_view value, Kind kind) { return value == "C" || (kind == Kind::wait_time && value == "0"); }

Answer set_wait(Rig& rig, Reader reader, Kind kind, std::int64_t highest) {
  const auto axes = reader.take_axes(rig.controllable);
  if (!axes || !reader.take(',')) return Answer::ng;
  if (is_cancel(reader.rest(), kind)) {
    rig.motions.end_wait(kind, *axes, rig.now);
    return Answer::ok;
  }
  Setting setting;
  setting.kind = kind;
  setting.axes = *axes;
  bool first = true;
  for (const int axis : axes->list()) {
    if (!first && !reader.take(',')) return Answer::ng;
    first = false;
    const auto value = reader.take_integer(0, highest);
    if (!value) return Answer::ng;
    setting.values[index_of(axis)] = *value;
  }
  if (!reader.done()) return Answer::ng;
  const auto accepted = rig.motions.set_prebuffer(setting);
  if (accepted == Motions::Accepted::no) return Answer::ng;
  const bool shows = rig.options.is("wait_reply_while_running", "ok_d");
  return shows && accepted == Motions::Accepted::chained ? Answer::ok_d : Answer::ok;
}

Answer wait_time(Rig& rig, Reader reader) { return set_wait(rig, reader, Kind::wait_time, 2550); }
Answer wait_input(Rig& rig, Reader reader) { return set_wait(rig, reader, Kind::wait_input, 63); }

constexpr std::array kBufferCommands = {
    Command{"M:", relative}, Command{"MP:", relative_next}, Command{"A:", absolute},    Command{"AP:", absolute_next},
    Command{"K:", line},     Command{"KP:", line_next},     Command{"E:", arc},         Command{"EP:", arc_next},
    Command{"J:", jog},      Command{"WT:", wait_time},     Command{"WI:", wait_input},
};

}  // namespace

const Command* find_buffer_command(std::string_view verb) {
  const auto found = std::find_if(kBufferCommands.begin(), kBufferCommands.end(),
                                  [&](const Command& command) { return command.verb == verb; });
  return found == kBufferCommands.end() ? nullptr : &*found;
}

}  // namespace axisgate::shrc203::simulator
