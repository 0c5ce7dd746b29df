// Reply that reports the trigger output (manual 42) ?:T).
#pragma once

#include <optional>
#include <string_view>

#include "device/shot/stage.h"

namespace axisgate::shot {

// Parses the answer to ?:T: NS, or m,v or m,a,v; nullopt for any other text, and for an axis that is not one of
// `axes`. The sign of v repeats what m says.
std::optional<Trigger> parse_trigger(std::string_view answer, AxisSet axes);

}  // namespace axisgate::shot
