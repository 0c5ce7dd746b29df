// The three alphabets in which the controller writes sets of axes. No letter converts to another alphabet's.
#pragma once

#include <optional>
#include <string_view>

#include "device/shrc203/stage.h"

namespace axisgate::shrc203 {

// Commands: 1 2 3, A=1+2, B=1+3, C=2+3, D=1+2+3 (manual 3) and everywhere an `a` is sent). W is "all controllable axes"
// and depends on the unit, so the gateway never sends it. command_letter wants at least one axis.
char command_letter(AxisSet axes);
std::optional<AxisSet> from_command_letter(char letter, AxisSet controllable);

// The status field s of Q: and SRQ: (manual 4), 6)): 1 2 3, C=1+2, D=1+3, E=2+3, W=all; nothing for K, R and the rest.
std::optional<AxisSet> from_status_letter(char letter);

// ?:AXIS (manual 44)): 0 to 6.
std::optional<AxisSet> from_axis_setting(std::string_view digit);

}  // namespace axisgate::shrc203
