// A checked command: a row of the command table, its arguments and its line.
#pragma once

#include <string>

#include "device/shot/command/axes.h"
#include "device/shot/command/command_row.h"
#include "device/shot/command/pattern.h"

namespace axisgate::shot {

struct Command {
  const CommandRow* row = nullptr;
  Arguments arguments;
  std::string line;  // in the strict form, without terminator

  // Returns the named axes; all of `controllable` if the command names no axes or W.
  AxisSet axes(AxisSet controllable) const;
};

}  // namespace axisgate::shot
