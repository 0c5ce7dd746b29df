#include "device/shot/command/command.h"

#include <algorithm>

namespace axisgate::shot {

AxisSet Command::axes(AxisSet controllable) const {
  const auto letter = arguments.first("a");
  const auto parameter = std::ranges::find(row->parameters, "a", &Parameter::letter);
  const bool time = letter && parameter->kind != Parameter::Kind::choice;  // interval of T:T (manual 97))
  if (!letter || time) return controllable;
  if (row->third_axis) return kLetteredAxes;
  return from_command_letter(letter->front(), controllable).value_or(controllable);
}

}  // namespace axisgate::shot
