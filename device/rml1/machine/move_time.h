// How long a mill may take for one straight move, or for a wait.
#pragma once

#include "device/rml1/machine/machine.h"
#include "device/rml1/machine/profile.h"

namespace axisgate::rml1 {

// Seconds. A mill does not say how it accelerates, nor whether it stops at each point.
struct StepTime {
  double least = 0;    // at full speed throughout
  double most = 0;     // from rest to rest, or slower throughout by the profile's part, whichever is longer
  double slowest = 0;  // both: what a bound of what runs on is computed with
};

// Without `knows_z0` nobody knows how far Z0 lies below the top, and clipping may leave out any way above Z0. Such a
// way then counts in `most` and `slowest` only.
StepTime move_time(const Move& move, const Profile& profile, bool knows_z0);
// `seconds` is the machine's figure. The time that a spindle needs is assumed, so it may need none.
StepTime wait_time(Wait what, double seconds, const Acceleration& acceleration);
// A mill may dwell before each point of a list (guideline 3-1 W, "when the cutting direction changes").
StepTime dwell_between_points(double seconds);

}  // namespace axisgate::rml1
