// Paths: checked, then run at their turn by path_run.h.
#pragma once

#include <functional>
#include <memory>

#include "device/core/tasks.h"
#include "device/shrc203/line/line_timing.h"
#include "device/shrc203/motion/disarming.h"
#include "device/shrc203/motion/entry.h"
#include "device/shrc203/motion/path_run.h"
#include "device/shrc203/planning/path_plan.h"
#include "device/shrc203/session/restorer.h"
#include "device/shrc203/state/motions.h"
#include "device/shrc203/state/rights.h"

namespace axisgate::shrc203 {

// From READY to the outcome; what it has changed is restored then. Approaches and scans are paths, too.
class PathFollower {
 public:
  PathFollower(PathParts& parts, Disarming& disarming, Restorer& restorer, const StateStore& store)
      : parts_(parts), disarming_(disarming), restorer_(restorer), store_(store) {}

  Task<void> follow(LiveMotionPtr live, PathPlan plan);

 private:
  PathParts& parts_;
  Disarming& disarming_;
  Restorer& restorer_;
  const StateStore& store_;
};

class Paths {
 public:
  Paths(Entry& entry, PathFollower& follower, const StateStore& store, Motions& motions, Rights& rights,
        const LineTiming& timing, Tasks& tasks)
      : entry_(entry),
        follower_(follower),
        store_(store),
        motions_(motions),
        rights_(rights),
        timing_(timing),
        tasks_(tasks) {}

  void run(PathRequest request, StageController::OnStarted started);
  // As plan_path(), and: the line can feed it. Where the axes and their speeds are known, which they are not always
  // before the motion's turn.
  Result<PathPlan> plan(const PathRequest& request) const;

 private:
  Task<void> run_at_turn(LiveMotionPtr live, PathRequest request, Register reg);

  Entry& entry_;
  PathFollower& follower_;
  const StateStore& store_;
  Motions& motions_;
  Rights& rights_;
  const LineTiming& timing_;
  Tasks& tasks_;
};

// not_allowed, where the profile lets no input pin start a motion. `what` names it.
Result<void> may_wait_for_inputs(const Profile& profile, std::string_view what);

}  // namespace axisgate::shrc203
