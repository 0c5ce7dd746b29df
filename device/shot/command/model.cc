#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "device/shot/command/command.h"

namespace axisgate::shrc203 {
namespace {

constexpr std::size_t kLineCharactersMax = 200;

Result<void> check_characters(std::string_view text) {
  const bool printable = std::ranges::all_of(text, [](char c) { return c >= ' ' && c <= '~'; });
  if (printable && !text.empty() && text.size() <= kLineCharactersMax) return {};
  if (text.empty()) return fail(Reason::malformed_line, "the line is empty", "give one command, such as ?:V");
  if (!printable) {
    return fail(Reason::malformed_line,
                "the line holds a character that is not printable ASCII (CR, LF and NUL are never sent from a field)",
                "give each command as a line of its own, without terminator");
  }
  return fail(Reason::malformed_line, fmt::format("the line is longer than {} characters", kLineCharactersMax));
}

std::string in_upper_case(std::string_view text) {
  std::string upper(text);
  for (char& c : upper) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return upper;
}

// Returns the command with the longest name that begins the text. G is skipped, since it begins too many texts.
const CommandRow* begun_by(std::string_view text) {
  const std::string upper = in_upper_case(text);
  const CommandRow* begun = nullptr;
  for (const CommandRow& row : command_table()) {
    if (!upper.starts_with(row.name) || row.name == "G") continue;
    if (begun == nullptr || row.name.size() > begun->name.size()) begun = &row;
  }
  return begun;
}

}  // namespace

AxisSet Command::axes(AxisSet controllable) const {
  const auto letter = arguments.first("a");
  const auto parameter = std::ranges::find(row->parameters, "a", &Parameter::letter);
  const bool time = letter && parameter->kind != Parameter::Kind::choice;  // interval of T:T (manual 97))
  if (!letter || time) return controllable;
  if (row->third_axis) return kAllAxes;
  return from_command_letter(letter->front(), controllable).value_or(controllable);
}

Command make_command(std::string_view name, const Arguments& arguments) {
  return make_command(command_row(name), arguments);
}

Command make_command(const CommandRow& row, const Arguments& arguments) {
  auto line = encode(row, arguments);
  if (!line) std::abort();
  return {&row, arguments, *std::move(line)};
}

Command make_command(std::string_view name, AxisSet axes) { return make_command(name, Arguments().axes(axes)); }

Result<Command> parse_command(std::string_view text) {
  if (auto good = check_characters(text); !good) return tl::unexpected(good.error());
  std::optional<Problem> wrong;
  for (const CommandRow& row : command_table()) {
    auto arguments = decode(row, text);
    if (!arguments) continue;
    if (!*arguments) {
      wrong = wrong.value_or(arguments->error());
      continue;
    }
    auto line = encode(row, **arguments);
    return Command{&row, **std::move(arguments), *std::move(line)};
  }
  if (wrong) return tl::unexpected(*std::move(wrong));
  if (const CommandRow* row = begun_by(text)) {
    return fail(Reason::malformed_line, fmt::format("\"{}\" has not the form of {}: {}", text, row->name, row->format),
                fmt::format("`axisctl commands {}` explains the letters", row->name));
  }
  return fail(Reason::unknown_command, fmt::format("\"{}\" is no command that the gateway knows", text),
              "`axisctl commands` lists them with their parameters");
}

}  // namespace axisgate::shrc203
