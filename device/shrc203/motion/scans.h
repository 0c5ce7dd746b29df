// Scans: the axis moves to the start of the run, the trigger is armed while the axis is stationary (T: is NG while
// busy, manual 98)), the axis runs, and at READY the trigger is restored.
#pragma once

#include "device/core/tasks.h"
#include "device/shrc203/motion/entry.h"
#include "device/shrc203/motion/paths.h"
#include "device/shrc203/motion/trigger_count.h"
#include "device/shrc203/planning/scan_plan.h"
#include "device/shrc203/session/reader.h"
#include "device/shrc203/state/motions.h"
#include "device/shrc203/state/rights.h"

namespace axisgate::shrc203 {

class Scans {
 public:
  Scans(Entry& entry, PathFollower& follower, TriggerCount& triggers, Reader& reader, const StateStore& store,
        Motions& motions, Rights& rights, Tasks& tasks)
      : entry_(entry),
        follower_(follower),
        triggers_(triggers),
        reader_(reader),
        store_(store),
        motions_(motions),
        rights_(rights),
        tasks_(tasks) {}

  void scan(ScanRequest request, StageController::OnStarted started);
  // Checks the request before the motion's turn.
  Result<void> check(const ScanRequest& request) const;

 private:
  Result<ScanPlan> plan(const ScanRequest& request, std::optional<Decimal> scale_pulse) const;
  Task<void> run(LiveMotionPtr live, ScanRequest request);

  Entry& entry_;
  PathFollower& follower_;
  TriggerCount& triggers_;
  Reader& reader_;
  const StateStore& store_;
  Motions& motions_;
  Rights& rights_;
  Tasks& tasks_;
};

}  // namespace axisgate::shrc203
