// Restoring of the trigger at the end of a scan.
#pragma once

#include "device/core/tasks.h"
#include "device/shrc203/session/restorer.h"
#include "device/shrc203/state/live_motion.h"
#include "device/shrc203/state/pending_restores.h"
#include "device/shrc203/state/state_store.h"

namespace axisgate::shrc203 {

class Disarming {
 public:
  Disarming(Restorer& restorer, PendingRestores& pending, const StateStore& store, Tasks& tasks)
      : restorer_(restorer), pending_(pending), store_(store), tasks_(tasks) {}

  // Restores the trigger. T: is refused while anything moves, which somebody at the front panel may cause, so it is
  // tried again until kTriggerRestoreLimit.
  Task<void> disarm(LiveMotionPtr live);

 private:
  Restorer& restorer_;
  PendingRestores& pending_;
  const StateStore& store_;
  Tasks& tasks_;
};

}  // namespace axisgate::shrc203
