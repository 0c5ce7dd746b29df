#include "device/shrc203/planning/transaction_lines.h"

#include <fmt/format.h>

#include <algorithm>

#include "device/core/guard.h"
#include "device/shrc203/command/builders.h"
#include "device/shrc203/command/command_table.h"

namespace axisgate::shrc203 {
namespace {

constexpr std::size_t kLinesMax = 100;

std::string_view name_of(Mode mode) {
  switch (mode) {
    case Mode::host:
      return "HOST";
    case Mode::program:
      return "program mode";
    case Mode::program_edit:
      return "program edit mode";
    case Mode::memory_switches:
      break;
  }
  return "memory switch edit mode";
}

// Outside HOST no other caller is answered, so the lines that leave HOST must also come back to it.
Result<void> check_modes(const std::vector<Command>& commands) {
  Mode mode = Mode::host;
  const bool leaves = leaves_host(commands);
  for (const Command& command : commands) {
    const CommandRow& row = *command.row;
    const bool moves = row.moves() || row.effect == Effect::motion_setting;
    if (leaves && moves && row.needs.mode == Mode::host) {
      return fail(Reason::invalid_request, fmt::format("{} moves, in lines that lead out of HOST", row.name),
                  "send the motion by itself, before or after them");
    }
    if ((row.meaning == Meaning::mode_or_format || row.restarts) && &command != &commands.back()) {
      return fail(Reason::invalid_request, fmt::format("nothing can follow {}", command.line), "make it the last line");
    }
    const bool works = row.needs.mode == mode || (row.answered_off_host() && mode != Mode::program_edit);
    if (!works) {
      return fail(Reason::incomplete_transaction,
                  fmt::format("{} works in {}, and the lines before it lead to {}", row.name, name_of(row.needs.mode),
                              name_of(mode)),
                  "send the whole sequence in one call: exec MS:ON ... MS:OFF, or P:R P:ON ... P:OFF P:H");
    }
    if (row.meaning == Meaning::program_pause && command.arguments.first("u") == "1") {
      return fail(Reason::invalid_request, "P:U1 continues a program that nobody here has started", "run it by P:S");
    }
    mode = row.enters.value_or(mode);
  }
  if (mode == Mode::host) return {};
  return fail(Reason::incomplete_transaction,
              fmt::format("the lines leave the controller in {}, where it answers nobody else", name_of(mode)),
              "come back in the same lines: exec MS:ON ... MS:OFF, or P:R P:ON ... P:OFF P:H");
}

// A motion setting without a start would run with another caller's start; a start without a setting would run whatever
// is set.
Result<void> check_transaction(const std::vector<Command>& commands) {
  const auto any = [&](auto of) { return std::ranges::any_of(commands, of); };
  const bool frame = any([](const Command& c) { return c.row->shifts_frame; });
  if (frame && any([](const Command& c) { return c.row->moves() || c.row->effect == Effect::motion_setting; })) {
    return fail(Reason::invalid_request, "these lines move and also set coordinates: their targets are not certain",
                "send R:, RC: or PSET: by itself, and the motion after it");
  }
  if (const auto good = check_modes(commands); !good) return good;
  if (commands.size() > 1 && any([](const Command& c) { return destination_question(c).has_value(); })) {
    return fail(Reason::invalid_request,
                "a motion to a saved position must be the only line: lines before it may change the position",
                "send it by itself");
  }
  bool set = false;
  for (const Command& command : commands) {
    const auto& row = *command.row;
    if (row.meaning == Meaning::jog) {
      return fail(Reason::invalid_request, fmt::format("{} is for a jog, which runs until somebody stops it", row.name),
                  "use `Jog`, under which an axis stops when its caller falls silent");
    }
    const Waits waits = waits_of(command);
    if (waits.set && waits.cancelled) {
      return fail(Reason::invalid_request, fmt::format("{} both sets and cancels waits", command.line),
                  "give each a line of its own");
    }
    if (row.effect == Effect::motion_setting || waits.set) set = true;
    const bool is_start = row.meaning == Meaning::go;
    if (row.effect == Effect::stop && commands.size() > 1) {
      return fail(Reason::invalid_request, "a stop must be the only line: it goes before everything else",
                  "send it by itself, or use `Stop`");
    }
    if (is_start && !set && guarded(Guard::no_bare_go)) {
      return fail(Reason::incomplete_transaction, fmt::format("{} alone would start whatever was set before", row.name),
                  "give the setting and the start together: exec 'M:1+P1000' 'G:1'");
    }
  }
  const bool started = any([](const Command& c) { return c.row->meaning == Meaning::go; });
  if (set && !started && guarded(Guard::no_set_without_go)) {
    return fail(Reason::incomplete_transaction,
                "a motion that is set and not started would run on somebody else's start",
                "give the setting and the start together: exec 'M:1+P1000' 'G:1'");
  }
  return {};
}

}  // namespace

Unit unit_of(std::string_view letter) {
  if (letter == "N") return Unit::nanometers;
  if (letter == "U") return Unit::micrometers;
  if (letter == "M") return Unit::millimeters;
  if (letter == "D") return Unit::degrees;
  return Unit::pulses;
}

Result<std::vector<Command>> check_lines(const std::vector<std::string>& lines) {
  std::vector<Command> commands;
  if (lines.empty() || lines.size() > kLinesMax) {
    return fail(Reason::invalid_request, fmt::format("a transaction has 1 to {} lines", kLinesMax));
  }
  for (std::size_t index = 0; index < lines.size(); ++index) {
    auto command = model().parse(lines[index]);
    if (!command && lines.size() > 1) command.error().message.insert(0, fmt::format("line {}: ", index + 1));
    if (!command) return tl::unexpected(command.error());
    commands.push_back(*std::move(command));
  }
  if (const auto good = check_transaction(commands); !good) return tl::unexpected(good.error());
  return commands;
}

bool needs_gate(const std::vector<Command>& commands) {
  return std::ranges::any_of(commands, [](const Command& command) {
    return command.row->effect != Effect::question && command.row->effect != Effect::stop &&
           !command.row->beside_motion;
  });
}

Waits waits_of(const Command& command) {
  Waits waits;
  const Register reg = command.row->reg;
  if (reg != Register::wt && reg != Register::wi) return waits;
  for (const auto& [letter, value] : command.arguments.values()) {
    if (letter == "w") (value == "0" ? waits.cancelled : waits.set) = true;
    if (letter == "i") (value == "C" ? waits.cancelled : waits.set) = true;
  }
  return waits;
}

bool leaves_host(const std::vector<Command>& commands) {
  return std::ranges::any_of(commands, [](const Command& command) { return command.row->enters.has_value(); });
}

AxisSet axes_moved(const std::vector<Command>& commands, AxisSet controllable) {
  AxisSet axes;
  for (const Command& command : commands) {
    if (command.row->moves() || command.row->effect == Effect::motion_setting) {
      axes = axes | command.axes(controllable);
    }
  }
  return axes & controllable;
}

bool completes(const std::vector<Command>& commands) {
  return std::ranges::any_of(
      commands, [](const Command& command) { return command.row->completes && command.row->meaning != Meaning::go; });
}

std::optional<Command> destination_question(const Command& command) {
  const bool place = command.row->meaning == Meaning::to_place;
  if (!place && command.row->meaning != Meaning::to_coordinates) return {};
  return commands::ask_saved(place ? commands::Saved::place : commands::Saved::coordinates,
                             *command.arguments.first("n"));
}

std::vector<AxisMove> moves_of(const Command& command, AxisSet controllable) {
  std::vector<AxisMove> moves;
  const auto axes = command.axes(controllable).list();
  std::int64_t sign = 1;
  Unit unit = Unit::pulses;
  for (const auto& [letter, value] : command.arguments.values()) {
    if (letter == "m") sign = value == "-" ? -1 : 1;
    if (letter == "u") unit = unit_of(value);
    if (letter != "y" || moves.size() >= axes.size()) continue;
    Decimal amount = *parse_decimal(value);
    amount.digits *= sign;
    moves.push_back({axes[moves.size()], {amount, unit}, {}});
  }
  return moves;
}

std::vector<AxisSpeeds> speeds_of(const Command& command, AxisSet controllable) {
  std::vector<AxisSpeeds> speeds;
  std::vector<Unit> units;  // units of the distances, in the order of the axes; speeds use the same units
  const auto axes = command.axes(controllable).list();
  for (const auto& [letter, value] : command.arguments.values()) {
    if (letter == "u") units.push_back(unit_of(value));
    const bool first = letter == "spds" || letter == "spd";
    if (first && speeds.size() < axes.size()) speeds.push_back({axes[speeds.size()], {}, {}});
    if (speeds.empty() || (!first && letter != "spdf")) continue;
    const std::size_t place = speeds.size() - 1;
    const Quantity speed{*parse_decimal(value), place < units.size() ? units[place] : Unit::pulses};
    const bool maximum = letter == "spdf" || (letter == "spd" && command.row->meaning == Meaning::maximum_speed);
    (maximum ? speeds.back().maximum : speeds.back().minimum) = speed;
  }
  return speeds;
}

AxisSet axes_sped(const std::vector<Command>& commands, SetsSpeeds which, AxisSet controllable) {
  AxisSet axes;
  for (const Command& command : commands) {
    if (command.row->sets_speeds != which) continue;
    const bool setting = command.row->effect == Effect::setting;
    if (setting || command.arguments.first("spds")) axes = axes | command.axes(controllable);
  }
  return axes;
}

AxisSet axes_used(const std::vector<Command>& commands, AxisSet controllable) {
  AxisSet axes;
  for (const Command& command : commands) {
    if (command.row->effect == Effect::question) continue;
    axes = axes | (command.row->scope == CommandScope::axes ? command.axes(controllable) : kAllAxes);
  }
  return axes;
}

Command as_sent(const Command& command) {
  const bool all = command.row->separation == Separation::all_axes && guarded(Guard::questions_for_all_axes);
  if (!all || !command.arguments.first("a")) return command;
  Arguments without;
  for (const auto& [letter, value] : command.arguments.values()) {
    if (letter != "a") without.add(letter, value);
  }
  return model().make(*command.row, without);
}

std::string picked(const Command& asked, const Reply& reply, AxisSet controllable) {
  if (reply.kind != Reply::Kind::data || as_sent(asked).line == asked.line) return reply.text;
  const AxisSet wanted = asked.axes(controllable);
  const bool whole = reply.fields.size() == kAxisCount;
  std::string answer;
  std::size_t place = 0;
  for (const int axis : (whole ? kAllAxes : controllable).list()) {
    if (place >= reply.fields.size()) break;
    const auto& field = reply.fields[place++];
    if (!wanted.has(axis)) continue;
    if (!answer.empty()) answer += ',';
    answer += field;
  }
  return answer;
}

}  // namespace axisgate::shrc203
