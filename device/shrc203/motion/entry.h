// How a motion is entered: its turn, and then what must be so before anything of it is set.
#pragma once

#include <functional>

#include "device/core/tasks.h"
#include "device/shrc203/line/line.h"
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

  // What a motion writes first, and whether it sets prebuffers (Motions::enter()). What the register holds on all its
  // axes is overwritten (manual 2. 2)).
  struct Writes {
    Register reg = Register::none;
    bool prebuffer = false;
  };
  // The motion's turn, and all of prepare(). False: it was refused, and has its outcome.
  Task<bool> enter(LiveMotionPtr live, Writes writes);
  // The same for one that sets no prebuffer, or has that to itself: what it writes depends on who has a turn beside it.
  Task<bool> enter(LiveMotionPtr live, std::function<Register()> reg);

  // Before anything is set: the axes are stationary, no late axis number can come, no setpoint is stale, what is
  // pending is restored, and the speeds are known.
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
