// Moves: set, start, watch.
#pragma once

#include "device/core/tasks.h"
#include "device/shrc203/motion/approach.h"
#include "device/shrc203/motion/entry.h"
#include "device/shrc203/motion/speeds.h"
#include "device/shrc203/motion/starter.h"
#include "device/shrc203/motion/watch.h"
#include "device/shrc203/planning/plan.h"
#include "device/shrc203/session/restorer.h"
#include "device/shrc203/state/motions.h"
#include "device/shrc203/state/rights.h"

namespace axisgate::shrc203 {

class Moves {
 public:
  Moves(Entry& entry, MotionSpeeds& speeds, Starter& starter, Watch& watch, Restorer& restorer, Approaches& approaches,
        StateStore& store, Motions& motions, Rights& rights, Tasks& tasks)
      : entry_(entry),
        speeds_(speeds),
        starter_(starter),
        watch_(watch),
        restorer_(restorer),
        approaches_(approaches),
        store_(store),
        motions_(motions),
        rights_(rights),
        tasks_(tasks) {}

  void move(MoveRequest request, StageController::OnStarted started);
  // Checks the request against the envelope before the motion's turn, without positions while anything moves.
  Result<MovePlan> check(const MoveRequest& request) const;

 private:
  Task<void> run(LiveMotionPtr live, MoveRequest request);
  bool by_prebuffer(const LiveMotion& live) const;
  Result<MovePlan> plan(LiveMotion& live, const MoveRequest& request) const;
  Task<void> set_go_watch(LiveMotionPtr live, MovePlan plan, bool by_prebuffer);

  Entry& entry_;
  MotionSpeeds& speeds_;
  Starter& starter_;
  Watch& watch_;
  Restorer& restorer_;
  Approaches& approaches_;
  StateStore& store_;
  Motions& motions_;
  Rights& rights_;
  Tasks& tasks_;
};

}  // namespace axisgate::shrc203
