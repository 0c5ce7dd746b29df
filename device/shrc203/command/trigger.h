// Lines that set the trigger output (manual 97) to 101)): one setting per controller.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "device/shot/command/command.h"
#include "device/shrc203/stage.h"

namespace axisgate::shrc203 {

// Return the line that sets the trigger: trigger_command() for a trigger that was reported, trigger_line() for one that
// a caller requests. trigger_line() fails with out_of_range.
Command trigger_command(const Trigger& trigger);
Result<std::string> trigger_line(const Trigger& trigger);

// Returns the trigger that an accepted T: line sets; nullopt for other lines, and for T:M, which fires once and sets
// nothing.
std::optional<Trigger> trigger_of(const Command& command);

}  // namespace axisgate::shrc203
