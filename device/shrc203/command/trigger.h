// The trigger output (manual 97) to 101)): one setting per controller, reported by ?:T (manual 42)).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "device/shrc203/command/codec.h"

namespace axisgate::shrc203 {

// The answer to ?:T: NS, or m,v or m,a,v; nothing where it is none. A sign of v says what m says already.
std::optional<Trigger> parse_trigger(std::string_view answer);

// The line that sets it: of a trigger that was reported, and of one that a caller wants. out_of_range.
Command trigger_command(const Trigger& trigger);
Result<std::string> trigger_line(const Trigger& trigger);

// What an accepted line of T: sets; nothing for any other, and for T:M, which fires once and sets nothing.
std::optional<Trigger> trigger_of(const Command& command);

}  // namespace axisgate::shrc203
