// Origin returns, mechanical (HRT:) and logical (ZRT:): one line starts them, and each axis reports its end by a
// completion.
#pragma once

#include "device/core/tasks.h"
#include "device/shrc203/motion/entry.h"
#include "device/shrc203/motion/speeds.h"
#include "device/shrc203/motion/starter.h"
#include "device/shrc203/motion/watch.h"
#include "device/shrc203/session/restorer.h"
#include "device/shrc203/state/motions.h"
#include "device/shrc203/state/rights.h"

namespace axisgate::shrc203 {

class Homes {
 public:
  Homes(Entry& entry, MotionSpeeds& speeds, Starter& starter, Watch& watch, Restorer& restorer, StateStore& store,
        Motions& motions, Rights& rights, Tasks& tasks)
      : entry_(entry),
        speeds_(speeds),
        starter_(starter),
        watch_(watch),
        restorer_(restorer),
        store_(store),
        motions_(motions),
        rights_(rights),
        tasks_(tasks) {}

  // `kind` is home or return_to_origin.
  void home(MotionKind kind, HomeRequest request, StageController::OnStarted started);

 private:
  Result<void> check(MotionKind kind, AxisSet axes, const RequestContext& context) const;
  Result<void> check_logical_origin(AxisSet axes, const Envelope& limits) const;
  Result<void> check_alone(MotionKind kind, AxisSet axes) const;
  Task<void> run(LiveMotionPtr live);
  Task<void> start_and_watch(LiveMotionPtr live, Command command);

  Entry& entry_;
  MotionSpeeds& speeds_;
  Starter& starter_;
  Watch& watch_;
  Restorer& restorer_;
  StateStore& store_;
  Motions& motions_;
  Rights& rights_;
  Tasks& tasks_;
};

}  // namespace axisgate::shrc203
