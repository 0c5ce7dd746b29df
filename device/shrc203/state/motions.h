// The motions: those without an outcome, their turns on the axes, and the newest of those that have ended. What changes
// a motion's life, and what reports it.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "device/core/problem.h"
#include "device/core/tasks.h"
#include "device/core/violations.h"
#include "device/shrc203/line/line.h"
#include "device/shrc203/state/live_motion.h"
#include "device/shrc203/state/motion_gate.h"
#include "device/shrc203/state/registers.h"
#include "device/shrc203/state/rights.h"
#include "device/shrc203/state/state_store.h"

namespace axisgate::shrc203 {

class Motions {
 public:
  using OnStarted = StageController::OnStarted;
  using Live = std::map<MotionId, LiveMotionPtr>;

  Motions(StateStore& store, const Line& line, Registers& registers, Rights& rights, Tasks& tasks,
          Violations& violations);

  // Before the first: the next has the number behind this one.
  void number_after(MotionId last) { last_ = last; }
  // A new one, which waits for enter().
  LiveMotionPtr create(MotionKind kind, AxisSet axes, RequestContext context, OnStarted started);
  // Its turn. `prebuffer`: it will set prebuffers, which belong to one motion unless the profile says that each axis
  // has its own. queue_full, deadline_passed, what Rights refuse, stopped, not_sent.
  Task<Result<void>> enter(LiveMotionPtr live, bool prebuffer);
  // A line of its own goes out.
  void written(LiveMotion& live);
  // Its start was accepted, or its axes were seen to move. Nothing where it is running already.
  void started(LiveMotion& live);
  // It should be over by then.
  void due(LiveMotion& live, TimePoint over);
  void jog_changed(LiveMotion& live, JogEvent event);

  // The jog must end: `why`, or nothing where its caller wants it. Not where it must already, or was stopped.
  void end_jog(LiveMotion& live, std::optional<Problem> why);

  // Its outcome; only the first counts.
  void end(LiveMotion& live, MotionState outcome, std::optional<Problem> problem);
  // Before anything of it was sent: stopped where that is the problem, else failed.
  void refuse(LiveMotion& live, const Problem& problem);
  // A step of it did not succeed: stopped where a stop was requested, otherwise failed.
  void disconnect(LiveMotion& live, const Problem& problem);
  // Of one that restores something: all of that is over.
  void leave(LiveMotion& live);

  // From outside. A caller wants these axes to stop: the keeper of leases learns of it before anything is stopped.
  void stop_requested(const RequestContext& by, AxisSet axes);
  void stop_asked(LiveMotion& live, const std::string& who);
  // All on these axes. Those that it has stopped.
  std::vector<MotionId> stop_asked(AxisSet axes, const std::string& who);
  // All that have their turn; and those that wait for it are refused.
  void line_lost(const std::string& why);
  void completion_seen(int axis, bool doubtful, bool deduced);

  // A reading showed these axes stationary: motions that ended UNKNOWN now leave them.
  void seen_stationary(AxisSet axes);
  // The axes of a motion that ended UNKNOWN and were not seen stationary since.
  AxisSet left_moving(MotionId id) const;

  const Live& live() const { return live_; }
  LiveMotionPtr find_live(MotionId id) const;  // null: none
  std::optional<Motion> find(MotionId id) const;
  std::vector<Motion> all() const;  // oldest first
  const std::deque<Motion>& ended() const { return ended_; }

  // The axes of motions that are shown as running, and of those that have their turn.
  AxisSet running() const;
  AxisSet inside() const;
  // Also of motions that have their outcome, and restore what they changed.
  AxisSet occupied() const;
  bool anything_moves() const;  // also somebody else's
  bool others_inside(const LiveMotion& live) const { return gate_.others_inside(live.motion.id); }
  AxisSet axes_to_itself(const LiveMotion& live) const { return gate_.axes_of(live.motion.id); }
  // In a chain the completions follow one another, so that they cannot be distinguished before its end.
  bool any_chain() const;

  MotionGate& gate() { return gate_; }
  // Those that have waited for their turn as long as they may end.
  void expire_waiting();
  // Notified when the pace of the polls may be another.
  Signal& pace_changed() { return pace_changed_; }
  // Notified when a motion has its outcome, and when it has left its axes.
  Signal& ended_or_left() { return ended_or_left_; }

 private:
  void change(LiveMotion& live, MotionEvent event);
  void show(LiveMotion& live, MotionState state);
  void has_left(MotionId id);
  std::string occupation_of(AxisSet axes) const;

  StateStore& store_;
  Registers& registers_;
  Rights& rights_;
  Tasks& tasks_;
  Violations& violations_;
  MotionGate gate_;
  Signal pace_changed_, ended_or_left_;
  Live live_;
  std::deque<Motion> ended_;
  std::map<MotionId, AxisSet> left_moving_;  // ended UNKNOWN, and were not seen stationary since
  std::map<MotionId, AxisSet> restoring_;
  MotionId last_ = 0;
};

// Its axes' places; those of others may go on moving.
Positions places_of(const LiveMotion& live, const State& state);
// stopped: by whom.
Problem stopped_by(const LiveMotion& live);

}  // namespace axisgate::shrc203
