// Restoring of pending settings (state/pending_restores.h): at a motion's end, before the next motion on its axes, at a
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
#include "device/use/permission.h"

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

  // Restores the speeds of a motion that has its outcome, and makes the motion leave its axes. No effect if it changed
  // none.
  Task<void> restore_after(LiveMotionPtr live);
  // Restores speeds that could not be restored at the end of a motion because the line was lost. Call before the next
  // motion on these axes.
  Task<void> restore_speeds(AxisSet axes, std::string caller);
  // Restores a trigger that a scan could not disarm because the line was lost. Call before anything moves again.
  // Returns whether no scan is pending any longer.
  Task<bool> restore_trigger(std::string caller);
  // Restores the settings of an ended lease, whose axes are not free until then. Waits if the line is down.
  void lease_ended(const EndedLease& lease) { tasks_.spawn(restore_settings_of(lease)); }
  // Restores all pending settings at the gateway's end, when nothing moves any longer: no lease outlives the gateway.
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
