// Gate for motions: it decides which motion may set and start next. The manual does not say whether one busy axis
// refuses the commands of the others. So by default one motion at a time passes; with busy_scope = axis, motions of
// different axes do.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "device/core/lane_queue.h"
#include "device/core/problem.h"
#include "device/core/tasks.h"
#include "device/shot/command/axes.h"
#include "device/shrc203/profile.h"
#include "device/shrc203/stage.h"
#include "device/shrc203/state/question_turn.h"

namespace axisgate::shrc203 {

class MotionGate {
 public:
  // `question` returns the question that motions wait for (question_turn.h).
  MotionGate(Tasks& tasks, Scope busy_scope, QuestionTurn::Waiting question)
      : tasks_(tasks), busy_scope_(busy_scope), question_turn_(std::move(question)) {}

  // Waits for the motion's turn. `not_after` may be TimePoint::max() for no limit. Fails with queue_full,
  // deadline_passed, or the problem given to withdraw(). Callers take turns. A motion of several axes that others use
  // in turn, so that they are never free at once, is no longer overtaken once it has waited kTurnAfter.
  OneShot<Result<void>> enter(MotionId id, AxisSet axes, const std::string& caller, TimePoint not_after);
  void leave(MotionId id);
  // Returns the axes that no other motion may set meanwhile: those of the motion, or all if one motion at a time
  // passes. Empty if the motion is not inside.
  AxisSet axes_of(MotionId id) const;
  bool others_inside(MotionId id) const { return inside_.size() > inside_.count(id); }

  // Keeps new motions out while a stop of these axes is open: the stop would take a new setpoint for a stale one and
  // stop it. Stops may overlap.
  void hold(AxisSet axes);
  void let_go(AxisSet axes);

  // Refuses the waiting motions for which chosen(id) is true.
  void withdraw(const std::function<bool(MotionId)>& chosen, const Problem& problem);
  // Refuses the waiting motions whose time has passed. inside(axes) returns text about the motions inside that have
  // these axes; empty if none has.
  void expire(const std::function<std::string(AxisSet)>& inside);
  // Admits all motions that may enter. Call it after any change that may end a question's turn.
  void admit();
  std::optional<TimePoint> next_deadline() const;
  std::size_t waiting() const { return queue_.size(Lane::motion); }

 private:
  struct Entry {
    MotionId id = 0;
    AxisSet axes;
    std::string caller;
    TimePoint not_after{}, since{};
    OneShot<Result<void>> answer;
  };
  AxisSet held() const;
  AxisSet busy() const;
  TimePoint overdue_since() const;
  std::set<MotionId> overtaking(AxisSet busy) const;
  std::string what_goes_first(const Entry& entry) const;

  Tasks& tasks_;
  Scope busy_scope_;
  QuestionTurn question_turn_;
  std::map<MotionId, AxisSet> inside_;
  std::vector<AxisSet> held_;
  LaneQueue<Entry> queue_;
};

}  // namespace axisgate::shrc203
