// Jogs: axes that run until they are stopped (manual 88) J:, 93) JD:). The controller would run them to their limit
// sensors even if the caller is gone, so the gateway stops them (jog_watchdog.h).
#pragma once

#include <vector>

#include "device/core/tasks.h"
#include "device/shrc203/motion/entry.h"
#include "device/shrc203/motion/jog_watchdog.h"
#include "device/shrc203/motion/speeds.h"
#include "device/shrc203/motion/starter.h"
#include "device/shrc203/motion/watch.h"
#include "device/shrc203/session/reader.h"
#include "device/shrc203/session/restorer.h"
#include "device/shrc203/session/stops.h"
#include "device/shrc203/state/motions.h"
#include "device/shrc203/state/rights.h"

namespace axisgate::shrc203 {

class Jogs {
 public:
  Jogs(Entry& entry, MotionSpeeds& speeds, Starter& starter, Watch& watch, JogWatchdog& watchdog, Reader& reader,
       Restorer& restorer, Stops& stops, StateStore& store, Motions& motions, Rights& rights, Tasks& tasks)
      : entry_(entry),
        speeds_(speeds),
        starter_(starter),
        watch_(watch),
        watchdog_(watchdog),
        reader_(reader),
        restorer_(restorer),
        stops_(stops),
        store_(store),
        motions_(motions),
        rights_(rights),
        tasks_(tasks) {}

  // Implement the functions of StageController.
  MotionId jog(JogRequest request, StageController::OnStarted started);
  Result<void> renew(MotionId id, const std::vector<JogRequest::Axis>& speeds);
  void end(MotionId id, std::optional<Problem> why);

 private:
  Task<void> run(LiveMotionPtr live, JogRequest request);
  Result<MovePlan> plan(LiveMotion& live, const JogRequest& request) const;
  Task<void> start(LiveMotionPtr live, MovePlan slower);

  Entry& entry_;
  MotionSpeeds& speeds_;
  Starter& starter_;
  Watch& watch_;
  JogWatchdog& watchdog_;
  Reader& reader_;
  Restorer& restorer_;
  Stops& stops_;
  StateStore& store_;
  Motions& motions_;
  Rights& rights_;
  Tasks& tasks_;
};

}  // namespace axisgate::shrc203
