// Time that a mill may take for one straight move, or for a wait.
#pragma once

#include "device/rml1/machine/machine.h"
#include "device/rml1/machine/profile.h"

namespace axisgate::rml1 {

// Times in seconds. A mill does not report its acceleration, nor whether it stops at each point.
struct StepTime {
  double least = 0;  // at full speed throughout
  double most = 0;  // longer one of two times: with a stop at both ends, or slower throughout by the profile's fraction
  double slowest = 0;  // with a stop at both ends and slower throughout; used to bound the run-on after an abort
};

// Returns the time of a move. Without `knows_z0` the distance of Z0 below the top is unknown, and clipping may leave
// out any distance above Z0; such a distance then counts in `most` and `slowest` only.
StepTime move_time(const Move& move, const Profile& profile, bool knows_z0);
// Returns the time of a wait. `seconds` is the machine's figure. The time that a spindle needs is assumed, so `least`
// is 0 for it.
StepTime wait_time(Wait what, double seconds, const Acceleration& acceleration);
// Returns the time of a dwell before each point of a list, which a mill may add (guideline 3-1 W, "when the cutting
// direction changes").
StepTime dwell_between_points(double seconds);

}  // namespace axisgate::rml1
