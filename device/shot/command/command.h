// Parses a line of text into a checked command, using the command table.
#pragma once

#include <string>
#include <string_view>

#include "device/core/problem.h"
#include "device/shot/command/axes.h"
#include "device/shot/command/command_row.h"
#include "device/shot/command/pattern.h"

namespace axisgate::shrc203 {

struct Command {
  const CommandRow* row = nullptr;
  Arguments arguments;
  std::string line;  // in the strict form, without terminator

  // Returns the named axes; all of `controllable` if the command names no axes or W.
  AxisSet axes(AxisSet controllable) const;
};

// Makes a command, for this folder and for tests; other code uses builders.h. The arguments must fit: an error here is
// a defect and aborts.
Command make_command(std::string_view name, const Arguments& arguments = {});
Command make_command(std::string_view name, AxisSet axes);
Command make_command(const CommandRow& row, const Arguments& arguments);

// Parses a line that a caller wrote. Fails with malformed_line for control or non-ASCII characters (also CR, LF, NUL),
// for more than 200 characters, and for a known command in another form; with unknown_command; with out_of_range.
Result<Command> parse_command(std::string_view text);

}  // namespace axisgate::shrc203
