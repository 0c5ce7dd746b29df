// Speeds S, F and time R of D:, set for one motion.
#pragma once

#include "device/core/problem.h"
#include "device/shrc203/planning/plan.h"
#include "device/shrc203/session/dialogue.h"
#include "device/shrc203/session/explainer.h"
#include "device/shrc203/state/live_motion.h"
#include "device/shrc203/state/state_store.h"

namespace axisgate::shrc203 {

class MotionSpeeds {
 public:
  MotionSpeeds(Dialogue& dialogue, Explainer& explainer, StateStore& store)
      : dialogue_(dialogue), explainer_(explainer), store_(store) {}

  // Sets the speeds of the plan by D:.
  Task<Result<void>> set(LiveMotionPtr live, MovePlan plan);
  // Sets lower speeds for axes whose own F exceeds the caller's limit. They are restored at the end of the motion.
  Task<Result<void>> slow_down(LiveMotionPtr live);

 private:
  Result<MovePlan> slowed_down(AxisSet axes, const Envelope& envelope) const;

  Dialogue& dialogue_;
  Explainer& explainer_;
  StateStore& store_;
};

}  // namespace axisgate::shrc203
