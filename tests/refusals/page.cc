#include "tests/refusals/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <sstream>
#include <utility>

namespace axisgate::refusals {
namespace {

constexpr std::string_view kIntroduction = R"(# SHRC-203: why it is refused

From each condition under which the manual lets the controller answer `NG` to what the gateway says of it. Made by
`tests/refusals/` from what the gateway reported with the simulator, command by command; do not edit it. `COMMANDS.md` has
each command's form and conditions, `refusals.cc` what the axes show and which commands that stands against.

- **Reason**, **gRPC**: those of `proto/axisgate/v1/common.proto`. The message names the line, the axis or the mode.
- **Sent**: whether the line is written when the condition has been there for three seconds, brought about at the front
  panel. What is answered `NG` has changed nothing; the gateway then asks the controller for the cause.
- Where nothing shows it, it is `UNEXPLAINED`, and the message holds what is known. `L:` with a motor off is `NG`, and no
  problem: the axis stands.
)";

std::string code(std::string_view text) { return fmt::format("`{}`", text); }

std::string in_cell(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
  return text;
}

struct Row {
  std::vector<std::string> commands;
  std::string cells;
};

void add(std::vector<Row>& rows, const std::string& command, const std::string& cells) {
  auto row = std::ranges::find(rows, cells, &Row::cells);
  if (row == rows.end()) row = rows.insert(rows.end(), Row{{}, cells});
  if (std::ranges::find(row->commands, command) == row->commands.end()) row->commands.push_back(command);
}

}  // namespace

std::map<std::string, std::string> codes_by_reason(const std::string& common_proto) {
  std::map<std::string, std::string> codes;
  std::istringstream lines(common_proto);
  std::string last_sentence;
  for (std::string line; std::getline(lines, line);) {
    const auto first = line.find_first_not_of(' ');
    if (first == std::string::npos) continue;
    line.erase(0, first);
    if (line.starts_with("//")) {
      const auto end = line.find_last_not_of(". ");
      const auto begin = line.find_last_of(". ", end);
      last_sentence = line.substr(begin + 1, end - begin);
    } else if (line.starts_with("REASON_")) {
      codes[line.substr(7, line.find(' ') - 7)] = last_sentence;
    }
  }
  return codes;
}

std::string refusals_page(const std::vector<Outcome>& outcomes, const std::map<std::string, std::string>& codes) {
  std::string page(kIntroduction);
  for (std::size_t i = 0; i < outcomes.size();) {
    const Condition& condition = *outcomes[i].condition;
    std::vector<Row> rows;
    for (; i < outcomes.size() && outcomes[i].condition == &condition; ++i) {
      const Outcome& outcome = outcomes[i];
      const std::string reason(outcome.told.problem ? name(outcome.told.problem->reason) : "-");
      const std::string hint = outcome.told.problem ? outcome.told.problem->hint : "";
      add(rows, code(outcome.one->sentence->command),
          fmt::format("{} | {} | {} | {}", code(reason), codes.contains(reason) ? codes.at(reason) : "-",
                      outcome.sent ? "yes" : "no", in_cell(hint)));
    }
    page += fmt::format("\n## {}\n\n{}.\n\n| commands | reason | gRPC | sent | what helps |\n|---|---|---|---|---|\n",
                        condition.name, condition.manual);
    for (const Row& row : rows) {
      std::string commands;
      for (const std::string& command : row.commands) commands += (commands.empty() ? "" : " ") + command;
      page += fmt::format("| {} | {} |\n", commands, row.cells);
    }
  }
  return page;
}

}  // namespace axisgate::refusals
