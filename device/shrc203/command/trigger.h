// The trigger output (manual 97) to 101)): one setting per controller, reported by ?:T (manual 42)).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "device/shot/command/command.h"

namespace axisgate::shrc203 {

// Parses the answer to ?:T: NS, or m,v or m,a,v; nullopt for any other text. The sign of v repeats what m says.
std::optional<Trigger> parse_trigger(std::string_view answer);

// Return the line that sets the trigger: trigger_command() for a trigger that was reported, trigger_line() for one that
// a caller requests. trigger_line() fails with out_of_range.
Command trigger_command(const Trigger& trigger);
Result<std::string> trigger_line(const Trigger& trigger);

// Returns the trigger that an accepted T: line sets; nullopt for other lines, and for T:M, which fires once and sets
// nothing.
std::optional<Trigger> trigger_of(const Command& command);

}  // namespace axisgate::shrc203
