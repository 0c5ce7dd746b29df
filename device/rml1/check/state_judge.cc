#include "device/rml1/check/state_judge.h"

#include <fmt/format.h>

#include <algorithm>

namespace axisgate::rml1 {

void StateJudge::executed(const Instruction& instruction) {
  if (instruction.row->coordinates == Coordinates::relative) relative_ = instruction.place;
  switch (instruction.row->operation) {
    case Operation::dwell:
      dwell_ = instruction.place;
      return;
    case Operation::surface:
      return set_surface(instruction);
    case Operation::revolutions:
      return set_revolutions(instruction);
    case Operation::extension:
      return turn(instruction);
    case Operation::ignored:
      leaves_.tool = true;
      return;
    default:
      return;
  }
}

// Notes that the job sets Z0, which no command resets: "There is no change before and after command execution in ...
// the value of Z0" (3-1 H, 3-2 IN).
void StateJudge::set_surface(const Instruction& instruction) {
  if (leaves_.surface) return;
  leaves_.surface = true;
  diagnostics_.note(instruction.place, "3-3", [] {
    return "!ZO sets Z0: heights count from the new Z0, also in the next job, and the one set at the panel is lost";
  });
}

// Notes that the job sets the spindle speed, which is not in the lists of what DF and IN reset (3-2).
void StateJudge::set_revolutions(const Instruction& instruction) {
  if (revolutions_reported_ || instruction.count == 0) return;
  revolutions_reported_ = true;
  leaves_.revolutions = profile_.spindle.law != Spindle::Law::fixed;
  diagnostics_.note(instruction.place, "3-3", [this] {
    return profile_.spindle.law == Spindle::Law::fixed
               ? fmt::format("!RC sets the spindle speed; the {} ignores it", profile_.name)
               : std::string("!RC sets the spindle speed: IN and DF do not reset it, and the next job begins with it");
  });
}

void StateJudge::turn(const Instruction& instruction) {
  const auto turns = [this](const AxisTarget& axis) { return axis.letter == profile_.rotary->letter; };
  leaves_.rotation |= profile_.rotary && std::ranges::any_of(instruction.axes, turns);
}

void StateJudge::finish(const Machine& machine) {
  if (machine.lowered_by_default()) {
    diagnostics_.warn(Warning::profile_height, *machine.lowered_by_default(), "3-3", [this] {
      return fmt::format("lowers the tool before it sets Z1: Z {:.2f} mm is from the profile, a mill may differ",
                         profile_.default_z1 * profile_.step_mm);
    });
  }
  if (machine.relative()) {
    diagnostics_.warn(Warning::ends_relative, relative_, "5-3", [] {
      return "the job ends in relative coordinates: the next job begins with them, unless it sends PA, H, IN or DF";
    });
  }
  if (machine.dwell_s() > 0) {
    diagnostics_.note(dwell_, "3-3", [&] {
      return fmt::format("the job ends with a dwell of {:g} s: the next job waits as well, unless it sends IN or DF",
                         machine.dwell_s());
    });
  }
}

}  // namespace axisgate::rml1
