// Duration of a move, computed from its speeds.
#pragma once

#include <map>
#include <optional>

#include "device/core/time.h"
#include "device/shrc203/planning/plan.h"

namespace axisgate::shrc203 {

// Returns the duration of a move of one axis over `way` pulses, from standstill to standstill: from S towards F with an
// acceleration that reaches F in R milliseconds, and back, with or without a part at F (manual 89) D:).
Duration travel_time(double way, const SpeedSetting& speed);

// Returns the duration for the slowest axis, at the move's own speeds if set, else the `known` ones. nullopt if a
// distance or speed is unknown.
std::optional<Duration> travel_time(const MovePlan& move, const Positions& from,
                                    const std::map<int, SpeedSetting>& known);

}  // namespace axisgate::shrc203
