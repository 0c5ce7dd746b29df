// Entry of a motion: its turn, and the conditions for writing its first setting.
#pragma once

#include <functional>

#include "device/core/tasks.h"
#include "device/shot/line/line.h"
#include "device/shrc203/session/dialogue.h"
#include "device/shrc203/session/explainer.h"
#include "device/shrc203/session/reader.h"
#include "device/shrc203/session/restorer.h"
#include "device/shrc203/state/motions.h"
#include "device/shrc203/state/registers.h"

namespace axisgate::shrc203 {

class Entry {
 public:
  Entry(Dialogue& dialogue, const Line& line, Reader& reader, Explainer& explainer, Restorer& restorer,
        const StateStore& store, Motions& motions, Registers& registers, Tasks& tasks)
      : dialogue_(dialogue),
        line_(line),
        reader_(reader),
        explainer_(explainer),
        restorer_(restorer),
        store_(store),
        motions_(motions),
        registers_(registers),
        tasks_(tasks) {}

  // First register that a motion writes, and whether the motion sets prebuffers (Motions::enter()). The motion
  // overwrites a setpoint in this register on all its axes (manual 2. 2)).
  struct Writes {
    Register reg = Register::none;
    bool prebuffer = false;
  };
  // Waits for the motion's turn and calls prepare(). Returns false if the motion was refused; it then has its outcome.
  Task<bool> enter(LiveMotionPtr live, Writes writes);
  // Does the same for a motion that sets no prebuffers, or only those of its axes: its register depends on the other
  // motions that have a turn.
  Task<bool> enter(LiveMotionPtr live, std::function<Register()> reg);

  // Prepares the first setting: the axes are stationary, no late completion is possible, no setpoint is stale, pending
  // settings are restored, and the speeds are known.
  Task<Result<void>> prepare(LiveMotionPtr live, Register reg);

 private:
  Task<Result<void>> wait_for_axes(LiveMotionPtr live);
  Task<Result<void>> restore_pending(LiveMotionPtr live);
  Task<Result<void>> clear_stale_setpoints(LiveMotionPtr live, Register reg);
  Task<Result<void>> delete_setpoints(LiveMotionPtr live, AxisSet axes);
  AxisSet lasting_setpoints(const LiveMotion& live, Register reg) const;

  Dialogue& dialogue_;
  const Line& line_;
  Reader& reader_;
  Explainer& explainer_;
  Restorer& restorer_;
  const StateStore& store_;
  Motions& motions_;
  Registers& registers_;
  Tasks& tasks_;
};

}  // namespace axisgate::shrc203
