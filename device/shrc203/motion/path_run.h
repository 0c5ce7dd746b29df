// Run of a path: segment 1 is set and started, and each later one is put into the prebuffer as soon as the previous one
// has left it.
//
//   set 1 ── go ── set 2 (OK_D) ── 1 ends: 2 runs, set 3 (OK_D) ── ... ── n ends, READY: the sum must be exact
//
// OK instead of OK_D means that the chain had ended (an underrun): the path continues from READY. Other doubts are also
// settled at READY, where the command counters show how far the path has come. A segment that waits for something
// (SegmentPlan::waits()) is set and started at READY, like segment 1 (segment_halt.h). The phases of a segment are
// those of state/segment_life.h.
//
// The line is kept free for the refill that follows the end of each segment but the last two (reservations.h).
#pragma once

#include <string>

#include "device/core/tasks.h"
#include "device/core/violations.h"
#include "device/shot/line/line.h"
#include "device/shrc203/motion/prebuffer.h"
#include "device/shrc203/motion/segment_halt.h"
#include "device/shrc203/motion/standstill.h"
#include "device/shrc203/motion/starter.h"
#include "device/shrc203/motion/watch.h"
#include "device/shrc203/planning/path_plan.h"
#include "device/shrc203/planning/refill_feasibility.h"
#include "device/shrc203/session/explainer.h"
#include "device/shrc203/state/motions.h"
#include "device/shrc203/state/segment_life.h"

namespace axisgate::shrc203 {

// Objects that the run of a path uses.
struct PathParts {
  Line& line;
  Dialogue& dialogue;
  Starter& starter;
  Standstill& standstill;
  SegmentHalt& halt;
  Prebuffer& prebuffer;
  Explainer& explainer;
  TriggerCount& triggers;
  Watch& watch;
  StateStore& store;
  Motions& motions;
  Violations& violations;
  Tasks& tasks;
};

class PathRun {
 public:
  PathRun(PathParts& parts, LiveMotionPtr motion, PathPlan plan)
      : parts_(parts), live_(std::move(motion)), plan_(std::move(plan)) {}

  // Runs the path until the motion has its outcome.
  Task<void> run();

 private:
  int count() const { return static_cast<int>(plan_.segments.size()); }
  const SegmentPlan& segment(int number) const { return plan_.segments[static_cast<std::size_t>(number - 1)]; }
  const Place& begin_of(int number) const { return number == 1 ? plan_.begin : segment(number - 1).end; }
  Command setter(int number) const { return segment_setter(plan_, number); }
  // Returns the last segment that the controller accepted.
  int sent() const { return phase_ == SegmentPhase::chained ? running_ + 1 : running_; }
  bool chains(int number) const { return number <= count() && !segment(number).waits(); }
  bool stands_at_end(int number) const {
    return parts_.standstill.is_at(plan_.axes, segment(number).end, segment(number).slack);
  }
  bool returns(int number) const;
  bool over() const { return live_->life.has_outcome(); }
  bool interrupted() const { return live_->life.stop_asked() || live_->life.line_lost(); }

  void change(SegmentEvent event);
  void tell(PathProgress::Step step, int number, std::string reply = {});
  void end(MotionState outcome, Problem problem) { parts_.motions.end(*live_, outcome, std::move(problem)); }

  Task<bool> wait_before(int number);
  Task<bool> start(int number);  // sets and starts the segment, from READY
  Task<bool> advance();          // continues by one segment; false if only watching is left
  Task<void> refill(int number);
  Task<void> refill_refused(int number);
  Task<bool> wait_for_segment_end();
  bool completion_counts(const LiveMotion::Completion& completion);
  bool is_believed(const LiveMotion::Completion& completion);
  Task<void> start_from_rest(int number);
  Task<bool> become_stationary();
  Task<void> resume_from_ready();
  std::optional<int> last_run() const;
  Task<void> watch_end();

  Lane refill_lane() const;
  void keep_line_free(TimePoint due);
  void release_line() { parts_.line.release(live_->motion.id, parts_.tasks.now()); }

  PathParts& parts_;
  LiveMotionPtr live_;
  PathPlan plan_;
  SegmentPhase phase_ = SegmentPhase::stationary;
  int running_ = 0;     // segment that runs, or ran last
  int clock_axis_ = 0;  // first axis to complete; only its completions end segments. 0: none yet
  int missed_ = 0;      // segment ends found by polling, whose completion may still arrive
  TimePoint segment_began_{};
};

}  // namespace axisgate::shrc203
