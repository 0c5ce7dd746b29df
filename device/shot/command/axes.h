// The three alphabets in which the controller writes sets of axes. A letter of one alphabet must not be read in
// another.
#pragma once

#include <optional>
#include <string_view>

#include "device/shot/stage.h"

namespace axisgate::shot {

// Axes that a letter other than a digit can name.
inline constexpr AxisSet kLetteredAxes = AxisSet::first(3);

// Letters of commands: 1 2 3, A=1+2, B=1+3, C=2+3, D=1+2+3 (manual 3) and every command with an `a`). W means "all
// controllable axes" and depends on the controller, so the gateway never sends it. command_letter() returns nullopt for
// axes that no letter names.
std::optional<char> command_letter(AxisSet axes);
std::optional<AxisSet> from_command_letter(char letter, AxisSet controllable);

// Letters of the status field s in Q: and SRQ: (manual 4), 6)): 1 2 3, C=1+2, D=1+3, E=2+3, W=all. nullopt for K, R and
// all other letters.
std::optional<AxisSet> from_status_letter(char letter);

// Digits of ?:AXIS (manual 44)): 0 to 6.
std::optional<AxisSet> from_axis_setting(std::string_view digit);

}  // namespace axisgate::shot
