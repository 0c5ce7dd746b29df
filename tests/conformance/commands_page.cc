#include "tests/conformance/commands_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstdint>
#include <iterator>
#include <stdexcept>
#include <utility>
#include <vector>

#include "device/shrc203/command/command_table.h"

namespace axisgate::shrc203::conformance {
namespace {

constexpr std::string_view kIntroduction = R"(# SHRC-203: the commands

Every numbered command of the manual, in its order. Made from the command table (`rows_*.cc`) by
`tests/conformance/commands_page.cc`; do not edit it. `README.md` beside it explains how the gateway uses them,
`ERRATA.md` where the manual contradicts itself.

- **Command**: letters in `<>` are parameters; `[...]` may be left out; `{...|s}` stands once for each axis of `<a>`,
  with `s` between two. Callers may leave out the sign `+` and the unit of pulses, use either case, and put blanks after
  commas.
- **Reply**: `NG` and `NG_I` are possible for every command.
- **Conditions**: what the manual demands, or the answer is `NG`. *READY*: no axis concerned is BUSY; *excited*: their
  motors are; *no limit*: no limit sensor is detected. Then the mode in which it works; `Execute` takes the `?:`
  questions of HOST in program mode and memory switch edit mode, too.
- **Class**: what it does, for the axes that it names or the controller as a whole. Of a question, how its answer is kept
  apart from a completion, which is a bare `1`, `2` or `3`: *by its form*; *sent for all axes*, so that it has commas;
  *waits* until no completion can come; *closed* by an `!:S` after it while a single motion runs.
- **RPC**, **axisctl**: the typed call and the verb that do it, or tell it. They send `HRT:` and `ZRT:` where `H:` and
  `Z:` would do the same, `D:` for `DS:`, `DF:` and `DR:`, `EP:` for `E:`, `KP:` for `K:`, `PIT:GRT` and `PAV:GRT` for
  `PIT:G` and `PAV:G`, and an origin return of the kind that the controller is set to; where `WT:` and `WI:` would wait,
  the gateway itself does. `CommandService.Execute` and `axisctl exec` take every command but `J:` and `JD:`.

| section | command | what it does | parameters | reply | conditions | class | RPC | axisctl |
|---|---|---|---|---|---|---|---|---|
)";

using Texts = std::vector<std::string>;

Texts split(std::string_view text, char separator) {
  Texts parts;
  while (true) {
    const auto end = std::min(text.find(separator), text.size());
    parts.emplace_back(text.substr(0, end));
    if (end == text.size()) return parts;
    text.remove_prefix(end + 1);
  }
}

std::string joined(const Texts& parts, std::string_view separator) {
  return fmt::format("{}", fmt::join(parts, separator));
}

// Returns the text as code. Escapes bars, because a bar ends a cell even inside code.
std::string code(std::string_view text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? "\\|" : std::string(1, c);
  return '`' + escaped + '`';
}

// Returns the number with separators: "1,000,000".
std::string grouped(std::int64_t number) {
  std::string digits = std::to_string(number);
  const std::size_t first = number < 0 ? 1 : 0;
  for (std::size_t i = digits.size(); i > first + 3; i -= 3) digits.insert(i - 3, ",");
  return digits;
}

std::string range(std::int64_t minimum, std::int64_t maximum) {
  return fmt::format("{} {} {}", grouped(minimum), maximum == minimum + 1 ? "or" : "to", grouped(maximum));
}

bool is_number(std::string_view text) {
  return !text.empty() && text.size() < 10 &&
         std::ranges::all_of(text, [](unsigned char c) { return std::isdigit(c) != 0; });
}

// Returns the choices as a list; three or more consecutive numbers become a range: "C, 0 to 63".
std::string listed(const Texts& choices) {
  Texts parts;
  for (std::size_t i = 0; i < choices.size();) {
    std::size_t end = i + 1;
    while (end < choices.size() && is_number(choices[end - 1]) && is_number(choices[end]) &&
           std::stoi(choices[end]) == std::stoi(choices[end - 1]) + 1) {
      ++end;
    }
    if (end - i < 3) end = i + 1;
    parts.push_back(end == i + 1 ? code(choices[i])
                                 : fmt::format("{} to {}", code(choices[i]), code(choices[end - 1])));
    i = end;
  }
  return joined(parts, ", ");
}

// Reports whether the meaning names all choices: "motor: 0 excitation off, 1 on" does, "direction" does not.
bool names_all(std::string_view meaning, const Texts& choices) {
  std::string words = " ";
  for (const char c : meaning) words += std::isalnum(static_cast<unsigned char>(c)) ? c : ' ';
  words += ' ';
  return std::ranges::all_of(
      choices, [&](const std::string& choice) { return words.find(' ' + choice + ' ') != std::string::npos; });
}

bool has_other_units(const CommandRow& row) { return row.format.find("<u>") != std::string_view::npos; }

std::string values(const CommandRow& row, const Parameter& parameter) {
  // A unit such as "0.1 s" contains a number, and is written as "times 0.1 s".
  const bool times = !parameter.unit.empty() && is_number(parameter.unit.substr(0, 1));
  const std::string unit = parameter.unit.empty() ? "" : fmt::format("{}{}", times ? " times " : " ", parameter.unit);
  switch (parameter.kind) {
    case Parameter::Kind::choice: {
      const Texts choices = split(parameter.choices, ' ');
      return names_all(parameter.meaning, choices) ? "" : listed(choices);
    }
    case Parameter::Kind::integer:
      return range(parameter.minimum, parameter.maximum) + unit;
    case Parameter::Kind::decimal:
      return range(parameter.minimum, parameter.maximum) + unit +
             (has_other_units(row) ? ", or a decimal in another unit" : "");
    case Parameter::Kind::angle:
      return fmt::format("more than 0, up to {}{}", grouped(parameter.maximum), unit);
    case Parameter::Kind::text:
      return "";
  }
  throw std::logic_error("an unknown kind of parameter");
}

std::string parameters(const CommandRow& row) {
  Texts parts;
  for (const Parameter& parameter : row.parameters) {
    // Rows share lists of parameters, and some rows use only the first ones.
    if (row.format.find(fmt::format("<{}>", parameter.letter)) == std::string_view::npos) continue;
    const std::string given = values(row, parameter);
    parts.push_back(fmt::format("{} {}{}", code(parameter.letter), parameter.meaning,
                                given.empty() ? "" : fmt::format(" ({})", given)));
  }
  return joined(parts, "; ");
}

constexpr std::pair<std::string_view, std::string_view> kFieldWords[] = {
    {"identity", "vendor, model, serial number, firmware"},
    {"ready", "`R` READY, `B` BUSY, `D` not controllable"},
    {"coordinate", "coordinate"},
    {"error", "`X` or `K`"},
    {"stop", "`K`, `R`, or the letter of axes"},
    {"amount", "unit, sign and coordinate"},
    {"hex", "hexadecimal status bits"},
    {"version", "`V` and digits"},
    {"decimal", "decimal"},
    {"axis_name", "`1` to `9` or `A` to `Z`"},
    {"speed", "`S...F...R...`"},
    {"setting", "amount, or `NS`"},
    {"arc", "kind, axes, rotation and amounts, or `NS`"},
    {"line", "axes and amounts, or `NS`"},
    {"model", "model name"},
    {"direction", "`+`, `-` or `NS`"},
    {"config", "`0`, `1`, `E` or `D`"},
    {"mode", "name of the mode"},
    {"format", "`SHOT_FC` or `HIT`"},
    {"echo", "that line"},
    {"numbers", "numbers"},
    {"trigger", "kind, axis, interval, or `NS`"},
    {"serial", "digits"},
    {"step", "letter and values"},
};

std::string field_in_words(std::string_view spec) {
  const bool each = spec.ends_with('*');
  if (each) spec.remove_suffix(1);
  const Texts parts = split(spec, ':');
  std::string text;
  if (parts.size() == 3) {
    text = range(std::stoll(parts[1]), std::stoll(parts[2])) + (parts[0] == "number_or_NS" ? ", or `NS`" : "");
  } else {
    const auto found = std::ranges::find(kFieldWords, spec, &std::pair<std::string_view, std::string_view>::first);
    if (found == std::end(kFieldWords)) throw std::logic_error(fmt::format("no words for the reply '{}'", spec));
    text = found->second;
  }
  return each ? "for each axis: " + text : text;
}

std::string reply(const CommandRow& row) {
  Texts parts;
  if (row.reply.starts_with("OK")) {
    parts.push_back(row.may_chain() ? "`OK` or `OK_D`" : "`OK`");
  } else {
    const Texts fields = split(row.reply, ',');
    for (std::size_t i = 0, next = 0; i < fields.size(); i = next) {
      while (next < fields.size() && fields[next] == fields[i]) ++next;
      parts.push_back(field_in_words(fields[i]) + (next > i + 1 ? fmt::format(", {} times", next - i) : ""));
    }
  }
  if (row.completes && row.effect == Effect::motion_setting) parts.emplace_back("axis numbers follow the start");
  if (row.completes && row.effect == Effect::motion) {
    parts.emplace_back(row.name.starts_with("G") ? "axis numbers follow a prebuffer setting" : "axis numbers follow");
  }
  if (row.reply_limit > Duration::zero()) {
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(row.reply_limit).count();
    parts.push_back(fmt::format("may take {} s", seconds));
  }
  return joined(parts, "; ");
}

std::string mode_in_words(Mode mode) {
  switch (mode) {
    case Mode::host:
      return "HOST";
    case Mode::program:
      return "program mode";
    case Mode::program_edit:
      return "program edit mode";
    case Mode::memory_switches:
      return "memory switch edit mode";
  }
  throw std::logic_error("an unknown mode");
}

std::string conditions(const CommandRow& row) {
  Texts parts;
  if (row.needs.ready) parts.emplace_back("READY");
  if (row.needs.excited) parts.emplace_back("excited");
  if (row.needs.no_limit) parts.emplace_back("no limit");
  parts.push_back(row.needs.any_mode ? "any mode" : mode_in_words(row.needs.mode));
  return joined(parts, ", ");
}

std::string separation(Separation separation) {
  switch (separation) {
    case Separation::grammar:
      return "by its form";
    case Separation::all_axes:
      return "sent for all axes";
    case Separation::waits:
      return "waits";
    case Separation::closed:
      return "closed";
  }
  throw std::logic_error("an unknown separation");
}

std::string effect(const CommandRow& row) {
  const std::string_view of = row.scope == CommandScope::axes ? " of the axes" : " of the controller";
  switch (row.effect) {
    case Effect::question:
      return "question, " + separation(row.separation);
    case Effect::setting:
      return fmt::format("setting{}", of);
    case Effect::motion_setting:
      return fmt::format("motion setting{}", of);
    case Effect::motion:
      return fmt::format("motion{}", of);
    case Effect::stop:
      return fmt::format("stop{}", of);
  }
  throw std::logic_error("an unknown effect");
}

std::string class_in_words(const CommandRow& row) {
  Texts parts{effect(row)};
  if (row.third_axis) parts.emplace_back("axis 3 moves along");
  if (row.shifts_frame) parts.emplace_back("new frame epoch");
  if (row.rescales) parts.emplace_back("the resolution changes");
  if (row.restarts) parts.emplace_back("the controller restarts");
  if (row.beside_motion) parts.emplace_back("waits for no motion");
  if (row.sets_speeds == SetsSpeeds::of_motion) parts.emplace_back("speeds stay set");
  if (row.sets_speeds == SetsSpeeds::of_origin_return) parts.emplace_back("speeds of the origin return stay set");
  if (row.enters) parts.push_back("leads to " + mode_in_words(*row.enters));
  return joined(parts, "; ");
}

std::string cells(const CommandRow& row) {
  const std::span<const TypedCall> calls = typed_calls();
  const auto call = std::ranges::find(calls, row.name, &TypedCall::row);
  const bool typed = call != calls.end();
  Texts verbs;
  for (const std::string& verb : split(typed ? call->verbs : "exec", ',')) {
    verbs.push_back(code(verb.substr(verb.find_first_not_of(' '))));
  }
  const Texts columns{fmt::format("{})", row.section),
                      code(row.format),
                      std::string(row.description),
                      parameters(row),
                      reply(row),
                      conditions(row),
                      class_in_words(row),
                      std::string(typed ? call->rpcs : "CommandService.Execute"),
                      joined(verbs, ", ")};
  return fmt::format("| {} |\n", joined(columns, " | "));
}

}  // namespace

std::string commands_page() {
  std::vector<const CommandRow*> rows;
  for (const CommandRow& row : model().commands()) rows.push_back(&row);
  std::ranges::stable_sort(rows, {}, [](const CommandRow* row) { return row->section; });
  std::string page(kIntroduction);
  for (const CommandRow* row : rows) page += cells(*row);
  return page;
}

}  // namespace axisgate::shrc203::conformance
