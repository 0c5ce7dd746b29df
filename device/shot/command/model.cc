#include "device/shot/command/model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace axisgate::shot {
namespace {

constexpr std::array<std::string_view, 4> kLineQuestions = {"*IDN?", "?:CMD", "!:", "!:S"};

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

}  // namespace

std::string_view text(LineQuestion question) { return kLineQuestions[static_cast<std::size_t>(question)]; }

Model::Model(std::string_view name, int axis_count, std::vector<CommandRow> commands, std::vector<Notice> notices)
    : name_(name),
      axis_count_(axis_count),
      commands_(std::move(commands)),
      notices_(std::move(notices)),
      questions_({make(kLineQuestions[0]), make(kLineQuestions[1]), make(kLineQuestions[2]), make(kLineQuestions[3])}) {
}

std::optional<ProgramNotice::Kind> Model::notice(std::string_view line) const {
  const auto found = std::ranges::find(notices_, line, &Notice::text);
  return found == notices_.end() ? std::nullopt : std::optional(found->kind);
}

const CommandRow& Model::row(std::string_view name) const {
  const auto found = std::ranges::find(commands_, name, &CommandRow::name);
  if (found == commands_.end()) std::abort();
  return *found;
}

Command Model::make(std::string_view name, const Arguments& arguments) const { return make(row(name), arguments); }

Command Model::make(const CommandRow& row, const Arguments& arguments) {
  auto line = encode(row, arguments);
  if (!line) std::abort();
  return {&row, arguments, *std::move(line)};
}

// Returns the command with the longest name that begins the text. G is skipped, since it begins too many texts.
const CommandRow* Model::begun_by(std::string_view text) const {
  const std::string upper = in_upper_case(text);
  const CommandRow* begun = nullptr;
  for (const CommandRow& row : commands_) {
    if (!upper.starts_with(row.name) || row.name == "G") continue;
    if (begun == nullptr || row.name.size() > begun->name.size()) begun = &row;
  }
  return begun;
}

Result<Command> Model::parse(std::string_view text) const {
  if (auto good = check_characters(text); !good) return tl::unexpected(good.error());
  std::optional<Problem> wrong;
  for (const CommandRow& row : commands_) {
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
                "`ListCommands` explains the letters");
  }
  return fail(Reason::unknown_command, fmt::format("\"{}\" is no command that the gateway knows", text),
              "`ListCommands` lists them with their parameters");
}

}  // namespace axisgate::shot
