// A path: segment 1 is set and started, each later one is put into the prebuffer as soon as its predecessor has left
// it.
//
//   set 1 ── go ── set 2 (OK_D) ── 1 ends: 2 runs, set 3 (OK_D) ── ... ── n ends, READY: the sum must be exact
//
// OK where OK_D was due means that the chain had ended (an underrun): the path goes on from READY. Whatever is in doubt
// is settled at READY too, where the command counters tell how far the path has come. A segment that waits for
// something (SegmentPlan::waits()) is set and started at READY as segment 1 is (path_rest.cc).
//
// The line is kept free for the refill that follows the end of each segment but the last two (reservations.h).
#pragma once

#include "device/shrc203/controller_impl.h"
#include "device/shrc203/planning/feeding.h"
#include "device/shrc203/planning/path_plan.h"

namespace axisgate::shrc203 {

class PathRun {
 public:
  PathRun(Controller::Impl& owner, LiveMotionPtr motion, PathPlan plan)
      : impl_(owner), live_(std::move(motion)), plan_(std::move(plan)) {}

  Task<void> run();

 private:
  int count() const { return static_cast<int>(plan_.segments.size()); }
  const SegmentPlan& segment(int number) const { return plan_.segments[static_cast<std::size_t>(number - 1)]; }
  Command setter(int number) const { return segment_setter(plan_, number); }
  Lane refill_lane() const {
    return impl_.profile_.refills == Refills::among_questions ? Lane::question : Lane::path_refill;
  }
  void tell(PathProgress::Step step, int number, std::string reply = {});
  bool over() const { return is_outcome(live_->motion.state); }
  void give_up(MotionState outcome, Problem problem) { impl_.end_motion(live_, outcome, std::move(problem)); }

  bool chains(int number) const { return number <= count() && !segment(number).waits(); }

  Task<bool> start(int number);   // set and go, from READY
  Task<bool> refill(int number);  // false: the chain has ended, or is in doubt
  Task<bool> wait_for_segment_end();
  Task<std::optional<Held>> read_prebuffer();
  Task<bool> prebuffer_left();
  Task<void> stop_wrong_segment();
  Task<void> resume_from_ready();
  Task<bool> wait_for_ready();
  // path_rest.cc
  Task<bool> wait_until(TimePoint limit);  // false: a stop, or the line was lost
  bool stands_at(const std::array<std::int64_t, kAxisCount>& place, std::int64_t slack) const;
  bool stands_at_end(int number) const { return stands_at(segment(number).end, segment(number).slack); }
  bool returns(int number) const;
  const std::array<std::int64_t, kAxisCount>& begin_of(int number) const {
    return number == 1 ? plan_.begin : segment(number - 1).end;
  }
  Task<bool> still_there(int number);
  Task<bool> come_to_rest();
  Task<void> start_from_rest(int number);
  Task<bool> wait_before(int number);  // for all that the segment waits for at READY
  Task<bool> wait_for_inputs(int pattern);
  Task<bool> arm(Trigger trigger);
  void show_armed(bool armed);

  void keep_line_free(TimePoint due);
  void release_line() { impl_.line_.release(live_->motion.id, impl_.now_); }
  void note_speed(int number);
  bool completion_counts(const LiveMotion::Completion& completion);

  Controller::Impl& impl_;
  LiveMotionPtr live_;
  PathPlan plan_;
  int running_ = 0;     // the segment that moves
  int sent_ = 0;        // the last one that the controller accepted
  int clock_axis_ = 0;  // the first axis to answer in segment 1; the others' numbers are not counted
  int missed_ = 0;      // ends that were asked for because their number had not come; it may still
  TimePoint segment_began_{};
};

}  // namespace axisgate::shrc203
