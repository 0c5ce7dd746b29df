// Moves that always approach their targets from the same side, so that backlash does not count. Each of them consists
// of two moves. A single axis has the second one in its prebuffer (manual 2. About double buffer) while the first runs.
// Several axes stop in between: the manual does not say whether each would continue by itself (README: chain_step_on).
#pragma once

#include "device/shot/line/line_timing.h"
#include "device/shrc203/motion/entry.h"
#include "device/shrc203/motion/paths.h"
#include "device/shrc203/planning/path_plan.h"
#include "device/shrc203/state/motions.h"
#include "device/shrc203/state/state_store.h"

namespace axisgate::shrc203 {

class Approaches {
 public:
  Approaches(Entry& entry, PathFollower& follower, const StateStore& store, Motions& motions, const LineTiming& timing)
      : entry_(entry), follower_(follower), store_(store), motions_(motions), timing_(timing) {}

  // Reports whether any axis has an approach.
  static bool has_any(const MoveRequest& request);
  // Returns both moves, checked against the envelope.
  Result<PathPlan> plan(const MoveRequest& request) const;
  Task<void> run(LiveMotionPtr live, MoveRequest request);

 private:
  Entry& entry_;
  PathFollower& follower_;
  const StateStore& store_;
  Motions& motions_;
  const LineTiming& timing_;
};

}  // namespace axisgate::shrc203
