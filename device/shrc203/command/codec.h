// From a person's line to a checked command, by the table.
#pragma once

#include <string>
#include <string_view>

#include "device/core/problem.h"
#include "device/shrc203/command/axes.h"
#include "device/shrc203/command/command_table.h"
#include "device/shrc203/command/pattern.h"

namespace axisgate::shrc203 {

struct Command {
  const CommandRow* row = nullptr;
  Arguments arguments;
  std::string line;  // strict, without terminator

  // The axes it names; all of `controllable` where it names none or W.
  AxisSet axes(AxisSet controllable) const;
};

// A command of this folder's own making, and of tests; see builders.h for the others'. The arguments must fit: a
// mistake here is a defect, and aborts.
Command make_command(std::string_view name, const Arguments& arguments = {});
Command make_command(std::string_view name, AxisSet axes);
Command make_command(const CommandRow& row, const Arguments& arguments);

// A line that a caller wrote. malformed_line for CR, LF, NUL, other control and non-ASCII characters, for more than 200
// characters, and for a command of the table in another form; unknown_command; out_of_range.
Result<Command> parse_command(std::string_view text);

}  // namespace axisgate::shrc203
