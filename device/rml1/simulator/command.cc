#include "device/rml1/simulator/command.h"

#include <algorithm>
#include <array>

namespace axisgate::rml1::simulator {
namespace {

constexpr Command pair_command(std::string_view name, Tool tool, Mode mode) {
  return {name, Action::plot, 2, true, tool, mode};
}

constexpr std::array kCommands = {
    pair_command("D", Tool::down, Mode::absolute),
    pair_command("I", Tool::down, Mode::relative),
    pair_command("M", Tool::up, Mode::absolute),
    pair_command("R", Tool::up, Mode::relative),
    pair_command("PD", Tool::down, Mode::unchanged),
    pair_command("PU", Tool::up, Mode::unchanged),
    pair_command("PA", Tool::unchanged, Mode::absolute),
    pair_command("PR", Tool::unchanged, Mode::relative),
    Command{"Z", Action::three_axes, 3, true},
    Command{"!ZZ", Action::three_axes, 3, true},
    Command{"!ZE", Action::extension},
    Command{"H", Action::home},
    Command{"IN", Action::initialize},
    Command{"DF", Action::defaults},
    Command{"F", Action::speed_xy, 1},
    Command{"VS", Action::speed_xy, 1},
    Command{"V", Action::speed_z, 1},
    Command{"!VZ", Action::speed_z, 1},
    Command{"W", Action::dwell, 1},
    Command{"!DW", Action::dwell, 1},
    Command{"!MC", Action::motor, 1},
    Command{"!RC", Action::revolutions, 1},
    Command{"!NR", Action::pause},
    Command{"@", Action::heights, 2},
    Command{"!PZ", Action::heights, 2},
    Command{"!ZM", Action::z_move, 1},
    Command{"!ZO", Action::z_origin, 1},
    Command{"!0", Action::motor},
    Command{"!1", Action::motor},
    Command{"J", Action::none, 1},
};

}  // namespace

const Command* find_command(std::string_view name) {
  const auto found =
      std::find_if(kCommands.begin(), kCommands.end(), [&](const Command& command) { return command.name == name; });
  return found == kCommands.end() ? nullptr : &*found;
}

bool is_mode_2(const Command& command) { return command.name.size() == 2 && command.name.front() != '!'; }

}  // namespace axisgate::rml1::simulator
