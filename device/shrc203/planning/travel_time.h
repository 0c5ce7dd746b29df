// How long the pulses of a move take, by its speeds.
#pragma once

#include <map>
#include <optional>

#include "device/core/time.h"
#include "device/shrc203/planning/plan.h"

namespace axisgate::shrc203 {

// Of one axis, from rest to rest, `way` pulses: from S towards F, which R milliseconds would lead to, and back, with or
// without a stretch at F (manual 89) D:).
Duration travel_time(double way, const SpeedSetting& speed);

// Of the axis that takes longest, by the speeds of the move, else the `known` ones. Nothing where a way or a speed is
// not known.
std::optional<Duration> travel_time(const MovePlan& move, const Positions& from,
                                    const std::map<int, SpeedSetting>& known);

}  // namespace axisgate::shrc203
