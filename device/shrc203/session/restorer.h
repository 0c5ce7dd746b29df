// Restores what is pending (state/pending_restores.h): at a motion's end, before the next motion on its axes, at a
// lease's end, and at the end of the gateway.
#pragma once

#include <span>
#include <string>

#include "device/core/tasks.h"
#include "device/shrc203/session/dialogue.h"
#include "device/shrc203/session/ending.h"
#include "device/shrc203/session/reader.h"
#include "device/shrc203/state/motions.h"
#include "device/shrc203/state/pending_restores.h"
#include "device/shrc203/state/state_store.h"
#include "device/stage/permission.h"

namespace axisgate::shrc203 {

class Restorer {
 public:
  Restorer(Dialogue& dialogue, Reader& reader, StateStore& store, Motions& motions, PendingRestores& pending,
           Permission& permission, const Ending& ending, Tasks& tasks)
      : dialogue_(dialogue),
        reader_(reader),
        store_(store),
        motions_(motions),
        pending_(pending),
        permission_(permission),
        ending_(ending),
        tasks_(tasks) {}

  // The motion has its outcome: its speeds are restored, and it leaves its axes. Nothing where it changed none.
  Task<void> restore_after(LiveMotionPtr live);
  // What could not be restored when a motion ended, because the line was lost: before the next one on these axes.
  Task<void> restore_speeds(AxisSet axes, std::string caller);
  // Likewise what a scan has armed, before anything moves again. Whether nothing is pending any more.
  Task<bool> restore_trigger(std::string caller);
  // The lease has ended and its axes are nobody's yet. A line that is down is waited for.
  void lease_ended(const EndedLease& lease) { tasks_.spawn(restore_settings_of(lease)); }
  // At the gateway's end, when nothing moves any more: no lease outlives it.
  Task<void> restore_everything();

 private:
  Task<bool> restore(PendingRestores what, std::span<const RestoredSetting> order, int tries, ExchangeRequest request);
  Task<bool> restore_one(PendingRestores what, RestoredSetting setting, ExchangeRequest request);
  Task<bool> restore_in_turn(EndedLease lease, PendingRestores what);
  Task<void> restore_settings_of(EndedLease lease);

  Dialogue& dialogue_;
  Reader& reader_;
  StateStore& store_;
  Motions& motions_;
  PendingRestores& pending_;
  Permission& permission_;
  const Ending& ending_;
  Tasks& tasks_;
};

}  // namespace axisgate::shrc203
