// Checks and properties of a caller's own lines, used before and after they are sent.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "device/core/problem.h"
#include "device/shot/command/command.h"
#include "device/shot/command/reply.h"
#include "device/shrc203/command/command_table.h"
#include "device/shrc203/stage.h"

namespace axisgate::shrc203 {

// Parses the lines and checks them as a whole. Fails as model().parse() does; with incomplete_transaction for a setting
// without a start or a start without a setting; with invalid_request for too many lines or a stop among other lines.
Result<std::vector<Command>> check_lines(const std::vector<std::string>& lines);

// Reports whether the lines must not come between another caller's lines.
bool needs_gate(const std::vector<Command>& commands);

// Reports whether the lines leave HOST and come back.
bool leaves_host(const std::vector<Command>& commands);

// Returns the axes that the lines move or prepare to move.
AxisSet axes_moved(const std::vector<Command>& commands, AxisSet controllable);

// Returns the axes that the lines change in any way: all, if a command concerns the whole controller.
AxisSet axes_used(const std::vector<Command>& commands, AxisSet controllable);

// Reports whether completions follow the lines.
bool completes(const std::vector<Command>& commands);

// Returns the unit of a letter u.
Unit unit_of(std::string_view letter);

// Returns the question for the target of a line that moves to a saved position (manual 130), 131), 135), 136)); nullopt
// for any other line.
std::optional<Command> destination_question(const Command& command);

// Returns the displacements or targets of a setter as AxisMoves, for the same travel checks as a move request.
std::vector<AxisMove> moves_of(const Command& command, AxisSet controllable);

struct AxisSpeeds {
  int axis = 0;
  std::optional<Quantity> minimum, maximum;  // S and F, per second
};
// Returns the speeds in a line: for each axis, or for the lowest axis of a straight line (manual 68), 84), 89) to 91),
// 94)).
std::vector<AxisSpeeds> speeds_of(const Command& command, AxisSet controllable);

// Returns the axes whose speeds of that kind the lines change permanently.
AxisSet axes_sped(const std::vector<Command>& commands, SetsSpeeds which, AxisSet controllable);

// Replaces a question for some axes by the question for all axes, so that the answer contains commas. Returns any other
// command unchanged.
Command as_sent(const Command& command);

// Returns the requested fields from the answer to as_sent(asked).
std::string picked(const Command& asked, const Reply& reply, AxisSet controllable);

// Effect of a WT: or WI: line. The end of a wait starts the motion in the prebuffer (manual 2. 3)).
struct Waits {
  bool set = false, cancelled = false;  // on at least one axis
};
Waits waits_of(const Command& command);

}  // namespace axisgate::shrc203
