// Waits of a segment while the axes are stationary: a rest, inputs, and the arming of a trigger. The gateway itself
// carries out these waits, so that a stop need not clear them in the controller. The manual does not say whether WT:
// and WI: are answered by OK or OK_D after a running segment, nor whether a completion reports their end (manual 57),
// 58)).
#pragma once

#include "device/core/tasks.h"
#include "device/shrc203/motion/standstill.h"
#include "device/shrc203/motion/trigger_count.h"
#include "device/shrc203/planning/path_plan.h"
#include "device/shrc203/session/dialogue.h"
#include "device/shrc203/session/explainer.h"
#include "device/shrc203/state/motions.h"
#include "device/shrc203/state/rights.h"
#include "device/shrc203/state/state_store.h"

namespace axisgate::shrc203 {

class SegmentHalt {
 public:
  SegmentHalt(Dialogue& dialogue, Explainer& explainer, Standstill& standstill, TriggerCount& triggers,
              StateStore& store, Motions& motions, Rights& rights, Tasks& tasks)
      : dialogue_(dialogue),
        explainer_(explainer),
        standstill_(standstill),
        triggers_(triggers),
        store_(store),
        motions_(motions),
        rights_(rights),
        tasks_(tasks) {}

  // Position of the axes at the beginning of the wait.
  struct Before {
    int number = 0;  // number of the waiting segment
    Place place{};
    std::int64_t slack = 0;
  };
  // Waits for everything that the segment needs. Returns false after a stop or the loss of the line, or if the motion
  // has its outcome.
  Task<bool> wait(LiveMotionPtr live, const SegmentPlan& next, Before before);

 private:
  Task<bool> is_still_there(LiveMotionPtr live, Before before);
  Task<bool> wait_for_inputs(LiveMotionPtr live, int pattern);
  bool has_lost_right(LiveMotion& live);
  void show_armed(const LiveMotion& live, bool armed);
  Task<bool> arm(LiveMotionPtr live, Trigger trigger);

  Dialogue& dialogue_;
  Explainer& explainer_;
  Standstill& standstill_;
  TriggerCount& triggers_;
  StateStore& store_;
  Motions& motions_;
  Rights& rights_;
  Tasks& tasks_;
};

}  // namespace axisgate::shrc203
