// What a path asks of its line: the controller holds one segment beside the running one (manual 2. Double buffer), so
// while each segment runs, all of the next one's setting must pass.
#pragma once

#include "device/shrc203/command/codec.h"
#include "device/shrc203/line/line_timing.h"
#include "device/shrc203/planning/path_plan.h"

namespace axisgate::shrc203 {

// The line that sets segment `number`, counted from 1.
Command segment_setter(const PathPlan& plan, int number);

// How long segment `number`, which is not the last, must run at least: the axis numbers that end the one before, the
// next one's line and its OK_D, what the controller usually takes to answer, and what a host takes to notice.
Duration shortest_feasible(const PathPlan& plan, int number, const LineTiming& timing);

// too_fast where a segment is shorter. The last one may last as short as it likes.
Result<void> check_refill_feasibility(const PathPlan& plan, const LineTiming& timing);

}  // namespace axisgate::shrc203
