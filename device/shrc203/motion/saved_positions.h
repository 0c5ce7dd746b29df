// Motion to a position that the controller stores by number: a place, PIT:, or coordinates, PAV: (manual 127) to 136)).
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "device/core/tasks.h"
#include "device/shrc203/motion/entry.h"
#include "device/shrc203/motion/speeds.h"
#include "device/shrc203/motion/starter.h"
#include "device/shrc203/motion/watch.h"
#include "device/shrc203/session/dialogue.h"
#include "device/shrc203/session/explainer.h"
#include "device/shrc203/session/restorer.h"
#include "device/shrc203/state/motions.h"
#include "device/shrc203/state/rights.h"

namespace axisgate::shrc203 {

using Coordinates = std::map<int, std::int64_t>;  // in pulses, by axis

class SavedPositions {
 public:
  SavedPositions(Dialogue& dialogue, Explainer& explainer, Entry& entry, MotionSpeeds& speeds, Starter& starter,
                 Watch& watch, Restorer& restorer, StateStore& store, Motions& motions, Rights& rights, Tasks& tasks)
      : dialogue_(dialogue),
        explainer_(explainer),
        entry_(entry),
        speeds_(speeds),
        starter_(starter),
        watch_(watch),
        restorer_(restorer),
        store_(store),
        motions_(motions),
        rights_(rights),
        tasks_(tasks) {}

  void go_to(GoToPositionRequest request, StageController::OnStarted started);
  // Checks the expected coordinates against the envelope before the motion's turn.
  Result<void> check(const GoToPositionRequest& request) const;

 private:
  Task<Result<void>> find(LiveMotionPtr live, GoToPositionRequest request);
  Task<void> run(LiveMotionPtr live, GoToPositionRequest request);

  Dialogue& dialogue_;
  Explainer& explainer_;
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

// Returns the coordinates that PIT:GET or PAV:GET reports twice in a row; empty if nothing is saved there. Fails with
// line_fault.
Task<Result<Coordinates>> ask_for_position(Dialogue& dialogue, LiveMotionPtr live, Command question,
                                           AxisSet controllable);

}  // namespace axisgate::shrc203
