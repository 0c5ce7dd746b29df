#include "device/shot/command/axes.h"

namespace axisgate::shot {

std::optional<char> command_letter(AxisSet axes) {
  if (axes.count() == 1) return static_cast<char>('0' + axes.lowest());
  if (axes.empty() || !kLetteredAxes.contains(axes)) return std::nullopt;
  if (axes == kLetteredAxes) return 'D';
  if (!axes.has(3)) return 'A';
  return axes.has(1) ? 'B' : 'C';
}

std::optional<AxisSet> from_command_letter(char letter, AxisSet controllable) {
  if (letter >= '1' && letter <= '0' + stage::kAxesMax) return AxisSet::of(letter - '0');
  switch (letter) {
    case 'A':
      return AxisSet::of(1) | AxisSet::of(2);
    case 'B':
      return AxisSet::of(1) | AxisSet::of(3);
    case 'C':
      return AxisSet::of(2) | AxisSet::of(3);
    case 'D':
      return kLetteredAxes;
    case 'W':
      return controllable;
    default:
      return std::nullopt;
  }
}

std::optional<AxisSet> from_status_letter(char letter) {
  switch (letter) {
    case '1':
      return AxisSet::of(1);
    case '2':
      return AxisSet::of(2);
    case '3':
      return AxisSet::of(3);
    case 'C':
      return AxisSet::of(1) | AxisSet::of(2);
    case 'D':
      return AxisSet::of(1) | AxisSet::of(3);
    case 'E':
      return AxisSet::of(2) | AxisSet::of(3);
    case 'W':
      return kLetteredAxes;
    default:
      return std::nullopt;
  }
}

std::optional<AxisSet> from_axis_setting(std::string_view digit) {
  if (digit.size() != 1) return std::nullopt;
  switch (digit.front()) {
    case '0':
      return AxisSet::of(1);
    case '1':
      return AxisSet::of(2);
    case '2':
      return AxisSet::of(3);
    case '3':
      return AxisSet::of(1) | AxisSet::of(2);
    case '4':
      return AxisSet::of(1) | AxisSet::of(3);
    case '5':
      return AxisSet::of(2) | AxisSet::of(3);
    case '6':
      return kLetteredAxes;
    default:
      return std::nullopt;
  }
}

}  // namespace axisgate::shot
