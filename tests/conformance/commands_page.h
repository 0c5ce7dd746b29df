// Generation of device/shrc203/COMMANDS.md from the command table, with every numbered command.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace axisgate::shrc203::conformance {

// A TypedCall lists the typed calls and verbs that send a row's command or report its answer. All other rows have
// Execute and exec.
struct TypedCall {
  std::string_view row;
  std::string_view rpcs;   // "StageService.Move"; several are separated by ", "
  std::string_view verbs;  // "move", likewise
};
std::span<const TypedCall> typed_calls();

// Returns the text of the file. Throws std::logic_error if the table contains something for which the page has no
// words.
std::string commands_page();

}  // namespace axisgate::shrc203::conformance
