// A motion without an outcome yet, and what its procedure needs to know of it.
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

// What READY must show for a success.
enum class Goal {
  targets,     // every axis at its target
  round_trip,  // likewise, and it was seen to run: it began there, so that standing there shows nothing
  none,        // not all of it was started, so that standing at its target is no success
};

// What a scan needs besides.
struct Scan {
  Trigger trigger;                       // that it runs with
  Trigger before;                        // that is restored
  std::optional<std::int64_t> armed_at;  // by the counter that the trigger counts
};

struct LiveMotion {
  LiveMotion(Executor& executor, Motion record, RequestContext from)
      : motion(std::move(record)), context(std::move(from)), changed(executor) {}

  // An axis number of it has come.
  struct Completion {
    int axis = 0;
    bool doubtful = false;
    TimePoint at{};
  };

  bool restores() const { return scan || !speeds_before.empty(); }
  bool completed_by_all() const { return completed == motion.axes; }

  Motion motion;
  MotionLife life;  // changed by Motions alone
  RequestContext context;
  Signal changed;    // a completion of its axes, a stop, the loss of the line
  int wake_ups = 0;  // how often all its axis numbers had come, or a stop
  StageController::OnStarted on_started;
  AxisSet uses;     // what it needs the right to: its axes, or all for a command that concerns the whole controller
  AxisSet excited;  // the axes whose motors must be on
  Goal goal = Goal::targets;
  int segments = 1;                // the axis numbers of all but the last come before its end
  std::int64_t slack = 0;          // pulses by which its end may lie beside its targets (manual 72))
  commands::Speeds speeds_before;  // restored when it has its outcome; none: it changes no speeds

  std::deque<Completion> completions;  // not yet looked at by the procedure
  AxisSet completed;                   // axes whose number has come at least once
  std::function<void(int axis)> on_completion;
  std::function<void()> on_success;  // before the outcome is reported
  std::optional<Jog> jog;
  std::optional<Scan> scan;
};
using LiveMotionPtr = std::shared_ptr<LiveMotion>;

}  // namespace axisgate::shrc203
