// What the lines of a caller's transaction come to, before and after they are sent.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "device/core/problem.h"
#include "device/shrc203/command/codec.h"
#include "device/shrc203/command/reply.h"
#include "device/shrc203/stage.h"

namespace axisgate::shrc203 {

// Parsed and checked as a whole: what parse_command() refuses, incomplete_transaction for a setting without a start or
// a start without a setting, invalid_request for too many lines or a stop among others.
Result<std::vector<Command>> check_lines(const std::vector<std::string>& lines);

// Whether the lines must not come between another's.
bool needs_gate(const std::vector<Command>& commands);

// Whether they lead out of HOST, and back.
bool leaves_host(const std::vector<Command>& commands);

// The axes that they set in motion or make ready to be.
AxisSet axes_moved(const std::vector<Command>& commands, AxisSet controllable);

// The axes that they change anything of: all, where a command concerns the whole controller.
AxisSet axes_used(const std::vector<Command>& commands, AxisSet controllable);

// Whether axis numbers follow.
bool completes(const std::vector<Command>& commands);

// Of a letter u.
Unit unit_of(std::string_view letter);

// The question where a line leads that goes to a saved position (manual 130), 131), 135), 136)); nothing for any other.
std::optional<Command> destination_question(const Command& command);

// The ways or targets that a setter names, as a request of ours, for the same checks of travel.
std::vector<AxisMove> moves_of(const Command& command, AxisSet controllable);

struct AxisSpeeds {
  int axis = 0;
  std::optional<Quantity> minimum, maximum;  // S and F, per second
};
// The speeds that a line names: of each axis, or of a straight line's lower one (manual 68), 84), 89) to 91), 94)).
std::vector<AxisSpeeds> speeds_of(const Command& command, AxisSet controllable);

// The axes whose speeds of that kind they set for good.
AxisSet axes_sped(const std::vector<Command>& commands, SetsSpeeds which, AxisSet controllable);

// The question for all axes in place of one for some, so that the answer has commas; any other command as it is.
Command as_sent(const Command& command);

// The requested fields of the answer to as_sent(asked).
std::string picked(const Command& asked, const Reply& reply, AxisSet controllable);

// What a line of WT: or WI: does; the end of a wait starts what is in the prebuffer (manual 2. 3)).
struct Waits {
  bool set = false, cancelled = false;  // on some axis
};
Waits waits_of(const Command& command);

}  // namespace axisgate::shrc203
