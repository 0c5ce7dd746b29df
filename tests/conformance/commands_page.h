// device/shrc203/COMMANDS.md, made from the command table: every numbered command with what the gateway knows of it.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace axisgate::shrc203::conformance {

// The typed calls and verbs that give a row's command or report its answer. All other rows have Execute and exec.
struct TypedCall {
  std::string_view row;
  std::string_view rpcs;   // "StageService.Move", several separated by ", "
  std::string_view verbs;  // "move", likewise
};
std::span<const TypedCall> typed_calls();

// The whole file. Throws std::logic_error where the table has something that this page has no words for.
std::string commands_page();

}  // namespace axisgate::shrc203::conformance
