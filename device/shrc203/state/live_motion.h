// A motion without an outcome yet, with the data of its procedure.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "device/core/task.h"
#include "device/shrc203/command/builders.h"
#include "device/shrc203/command/trigger.h"
#include "device/shrc203/stage.h"
#include "device/shrc203/state/jog_life.h"
#include "device/shrc203/state/motion_life.h"
#include "device/stage/stage_controller.h"

namespace axisgate::shrc203 {

// Condition at READY for success.
enum class Goal {
  targets,     // every axis is at its target
  round_trip,  // likewise, and the axes were seen to move: the motion began at its target, which alone shows nothing
  none,        // never a success: a part of the motion was not started
};

// A Scan is the trigger of a scan.
struct Scan {
  Trigger trigger;                       // trigger during the scan
  Trigger before;                        // trigger to restore
  std::optional<std::int64_t> armed_at;  // counter value at arming, of the counter that the trigger counts
};

struct LiveMotion {
  LiveMotion(Executor& executor, Motion record, RequestContext from)
      : motion(std::move(record)), context(std::move(from)), changed(executor) {}

  // A Completion is a received completion of one of the motion's axes.
  struct Completion {
    int axis = 0;
    bool doubtful = false;
    TimePoint at{};
  };

  bool restores() const { return scan || !speeds_before.empty(); }
  bool completed_by_all() const { return completed == motion.axes; }

  Motion motion;
  MotionLife life;  // changed by Motions only
  RequestContext context;
  Signal changed;    // notified by a completion of its axes, a stop, the loss of the line
  int wake_ups = 0;  // number of times that all completions had arrived, or a stop
  StageController::OnStarted on_started;
  AxisSet uses;     // axes that the motion needs the right to: its own, or all if it concerns the controller
  AxisSet excited;  // axes whose motors must be on
  Goal goal = Goal::targets;
  int segments = 1;                // completions of all segments but the last arrive before its end
  std::int64_t slack = 0;          // pulses by which its end may differ from its targets (manual 72))
  commands::Speeds speeds_before;  // to restore after the outcome; empty if it changes no speeds

  std::deque<Completion> completions;  // not yet processed by the procedure
  AxisSet completed;                   // axes with at least one completion
  std::function<void(int axis)> on_completion;
  std::function<void()> on_success;  // called before the outcome is reported
  std::optional<Jog> jog;
  std::optional<Scan> scan;
};
using LiveMotionPtr = std::shared_ptr<LiveMotion>;

}  // namespace axisgate::shrc203
