// Who may set and start a motion next. The manual does not say whether one busy axis refuses the others' commands, so
// by default one motion at a time goes through; with busy_scope = axis, motions of different axes do.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "device/core/lane_queue.h"
#include "device/core/problem.h"
#include "device/core/task.h"
#include "device/shrc203/command/axes.h"
#include "device/shrc203/profile.h"
#include "device/shrc203/stage.h"

namespace axisgate::shrc203 {

class MotionGate {
 public:
  MotionGate(Executor& executor, Scope busy_scope) : executor_(executor), busy_scope_(busy_scope) {}

  // `not_after` may be TimePoint::max(), for ever. co_await yields nothing once entered, or the problem that kept it
  // out: queue_full, deadline_passed, or what withdraw() was given. Callers take turns.
  OneShot<Result<void>> enter(MotionId id, AxisSet axes, const std::string& caller, TimePoint not_after);
  void leave(MotionId id);
  // What no other motion may set meanwhile: the axes of one inside, or all where one at a time goes through.
  AxisSet axes_of(MotionId id) const;
  bool others_inside(MotionId id) const { return inside_.size() > inside_.count(id); }

  // Until a stop of these axes is over nothing new is set on them: it would be taken for what the stop left behind, and
  // stopped. Stops may overlap.
  void hold(AxisSet axes);
  void let_go(AxisSet axes);

  // Turns away the waiting ones for which chosen(id) holds.
  void withdraw(const std::function<bool(MotionId)>& chosen, const Problem& problem);

  void expire(TimePoint now);
  std::optional<TimePoint> next_deadline() const;
  std::size_t waiting() const { return queue_.size(Lane::motion); }

 private:
  struct Entry {
    MotionId id = 0;
    AxisSet axes;
    TimePoint not_after{};
    OneShot<Result<void>> answer;
  };
  void admit();

  Executor& executor_;
  Scope busy_scope_;
  std::map<MotionId, AxisSet> inside_;
  std::vector<AxisSet> held_;
  LaneQueue<Entry> queue_;
};

}  // namespace axisgate::shrc203
