// Paths: checked, then run in their turn by path_run.h.
#pragma once

#include <functional>
#include <memory>

#include "device/core/tasks.h"
#include "device/shot/line/line_timing.h"
#include "device/shrc203/motion/disarming.h"
#include "device/shrc203/motion/entry.h"
#include "device/shrc203/motion/path_run.h"
#include "device/shrc203/planning/path_plan.h"
#include "device/shrc203/session/restorer.h"
#include "device/shrc203/state/motions.h"
#include "device/shrc203/state/rights.h"

namespace axisgate::shrc203 {

// A PathFollower runs a path from READY to the outcome, and restores the changed settings then. Approaches and scans
// are paths, too.
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
  // Plans like plan_path(). Also checks that the line can send the refills in time, once the axes and their speeds are
  // known: at the motion's turn at the latest.
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

// Fails with not_allowed if the profile lets no input pin start a motion. `what` names the request in the message.
Result<void> may_wait_for_inputs(const Profile& profile, std::string_view what);

}  // namespace axisgate::shrc203
