// Commands of guideline 1-2, and orders, which the reader passes to the machine.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace axisgate::rml1::simulator {

enum class Action {
  plot,        // PU PD PA PR M R D I
  three_axes,  // Z !ZZ
  extension,   // !ZE
  home,
  initialize,
  defaults,
  speed_xy,
  speed_z,
  dwell,
  motor,
  revolutions,
  pause,
  heights,
  z_move,
  z_origin,
  none,  // tolerated, without effect
};

enum class Tool { unchanged, up, down };
enum class Mode { unchanged, absolute, relative };

struct Command {
  std::string_view name;  // in capitals, without blanks
  Action action;
  int numbers = 0;  // maximum count, per set if `sets`
  bool sets = false;
  Tool tool = Tool::unchanged;  // effect of a plot (guideline 5-3, "Tool up/down")
  Mode mode = Mode::unchanged;  // effect of a plot (guideline 5-3, "Coordinate Modes")
};

// Returns null if no command has this name. Also finds "J", "!0" and "!1", which exist only on some machines.
const Command* find_command(std::string_view name);
bool is_mode_2(const Command& command);  // may be called by ^ (guideline 3-1)

struct AxisNumber {
  char axis = 0;
  double value = 0;
  bool has_point = false;
};

struct Order {
  const Command* command = nullptr;
  std::vector<double> numbers;   // one complete set, or all numbers of the command
  std::vector<AxisNumber> axes;  // one group of !ZE
  bool first = true;             // first order of its command
};

}  // namespace axisgate::rml1::simulator
