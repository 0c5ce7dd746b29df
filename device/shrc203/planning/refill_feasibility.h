// Checks that the line is fast enough for a path: the controller stores one segment besides the running one (manual 2.
// Double buffer), so the next segment must be set completely while each segment runs.
#pragma once

#include "device/shot/command/command.h"
#include "device/shot/line/line_timing.h"
#include "device/shrc203/planning/path_plan.h"

namespace axisgate::shrc203 {

// Returns the line that sets segment `number`, counted from 1.
Command segment_setter(const PathPlan& plan, int number);

// Returns the shortest feasible duration of segment `number`, which is not the last: the time for the completions of
// the segment before it, the line for the next segment and its OK_D, the controller's usual response time, and the
// host's reaction time.
Duration shortest_feasible(const PathPlan& plan, int number, const LineTiming& timing);

// Fails with too_fast if a segment is shorter than that. The last segment may have any duration.
Result<void> check_refill_feasibility(const PathPlan& plan, const LineTiming& timing);

}  // namespace axisgate::shrc203
