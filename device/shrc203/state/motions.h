// All motions: those without an outcome, their turns on the axes, and the newest ended ones. Only this class changes
// and reports the life of a motion.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "device/core/problem.h"
#include "device/core/tasks.h"
#include "device/core/violations.h"
#include "device/shot/line/line.h"
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

  // Numbers the next motion last + 1. Call before the first motion.
  void number_after(MotionId last) { last_ = last; }
  // Creates a motion, which is queued by enter().
  LiveMotionPtr create(MotionKind kind, AxisSet axes, RequestContext context, OnStarted started);
  // Waits for the motion's turn. `prebuffer`: the motion will set prebuffers, which belong to one motion unless the
  // profile gives each axis its own. Fails with queue_full, deadline_passed, stopped, not_sent, or a refusal of Rights.
  Task<Result<void>> enter(LiveMotionPtr live, bool prebuffer);
  // Called when one of the motion's lines is about to be sent.
  void written(LiveMotion& live);
  // Called when the motion's start was accepted, or its axes were seen to move. No effect if the motion is already
  // shown as running.
  void started(LiveMotion& live);
  // Notes the time by which the motion should be over.
  void due(LiveMotion& live, TimePoint over);
  void jog_changed(LiveMotion& live, JogEvent event);

  // Ends the jog. `why` is nullopt if its caller ends it. No effect if the jog must already end, or was stopped.
  void end_jog(LiveMotion& live, std::optional<Problem> why);

  // Sets the outcome; only the first one counts.
  void end(LiveMotion& live, MotionState outcome, std::optional<Problem> problem);
  // Ends a motion of which nothing was sent: STOPPED if that is the problem's reason, otherwise FAILED.
  void refuse(LiveMotion& live, const Problem& problem);
  // Ends a motion after a failed step: STOPPED if a stop was requested, otherwise FAILED.
  void disconnect(LiveMotion& live, const Problem& problem);
  // Makes the motion leave its axes once its settings are restored.
  void leave(LiveMotion& live);

  // Reports a caller's stop of these axes to the keeper of leases, before anything is stopped.
  void stop_requested(const RequestContext& by, AxisSet axes);
  void stop_asked(LiveMotion& live, const std::string& who);
  // Notes a stop in all motions on these axes. Returns these motions.
  std::vector<MotionId> stop_asked(AxisSet axes, const std::string& who);
  // Notes the loss of the line in all motions that have their turn, and refuses those that wait for it.
  void line_lost(const std::string& why);
  void completion_seen(int axis, bool doubtful, bool deduced);

  // Called when a reading showed these axes stationary. Motions that ended UNKNOWN leave them.
  void seen_stationary(AxisSet axes);
  // Returns the axes of a motion that ended UNKNOWN and that were not seen stationary since.
  AxisSet left_moving(MotionId id) const;

  const Live& live() const { return live_; }
  LiveMotionPtr find_live(MotionId id) const;  // null if there is none
  std::optional<Motion> find(MotionId id) const;
  std::vector<Motion> all() const;  // oldest first
  const std::deque<Motion>& ended() const { return ended_; }

  // Returns the axes of motions that are shown as running, and of those that have their turn.
  AxisSet running() const;
  AxisSet inside() const;
  // Returns the axes of inside(), and of motions that have their outcome and restore settings.
  AxisSet occupied() const;
  bool anything_moves() const;  // also in foreign motion
  bool others_inside(const LiveMotion& live) const { return gate_.others_inside(live.motion.id); }
  AxisSet axes_to_itself(const LiveMotion& live) const { return gate_.axes_of(live.motion.id); }
  // Reports whether a motion may be a chain: its completions follow one another and cannot be distinguished before its
  // end.
  bool any_chain() const;

  MotionGate& gate() { return gate_; }
  // Refuses the motions whose time limit for waiting has passed.
  void expire_waiting();
  // Notified when the pace of the polls may have changed.
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
  std::map<MotionId, AxisSet> left_moving_;  // ended UNKNOWN, and not seen stationary since
  std::map<MotionId, AxisSet> restoring_;
  MotionId last_ = 0;
};

// Returns the positions of the motion's axes only: other axes may still move.
Positions places_of(const LiveMotion& live, const State& state);
// Returns the problem `stopped`, which names who stopped the motion.
Problem stopped_by(const LiveMotion& live);

}  // namespace axisgate::shrc203
