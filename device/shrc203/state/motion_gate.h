// Who may set and start a motion next. The manual does not say whether one busy axis refuses the others' commands, so
// by default one motion at a time goes through; with busy_scope = axis, motions of different axes do.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "device/core/lane_queue.h"
#include "device/core/problem.h"
#include "device/core/tasks.h"
#include "device/shrc203/command/axes.h"
#include "device/shrc203/profile.h"
#include "device/shrc203/stage.h"
#include "device/shrc203/state/question_turn.h"

namespace axisgate::shrc203 {

class MotionGate {
 public:
  // `question`: for whose sake motions wait (question_turn.h).
  MotionGate(Tasks& tasks, Scope busy_scope, QuestionTurn::Waiting question)
      : tasks_(tasks), busy_scope_(busy_scope), question_turn_(std::move(question)) {}

  // `not_after` may be TimePoint::max(), for ever. co_await yields nothing once entered, or the problem that kept it
  // out: queue_full, deadline_passed, or what withdraw() was given. Callers take turns. A motion that needs axes which
  // are never free at once, since others use them in turn, is not overtaken there once it has waited kTurnAfter.
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
  // Turns away those whose time has passed. inside(axes) says which motions inside have these axes, for people; empty
  // where none has.
  void expire(const std::function<std::string(AxisSet)>& inside);
  // To be called after whatever may have let a question go that keeps motions out.
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
