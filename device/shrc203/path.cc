// A path: segment 1 is set and started, each later one is put into the prebuffer as soon as its predecessor has left
// it.
//
//   set 1 ── go ── set 2 (OK_D) ── 1 ends: 2 runs, set 3 (OK_D) ── ... ── n ends, READY: the sum must be exact
//
// OK where OK_D was due means that the chain had ended (an underrun): the path goes on from READY. Whatever is in doubt
// is settled at READY too, where the command counters tell how far the path has come.
//
// The line is kept free for the refill that follows the end of each segment but the last two (reservations.h).
#include <fmt/format.h>

#include <algorithm>

#include "device/core/guard.h"
#include "device/shrc203/controller_impl.h"
#include "device/shrc203/feeding.h"
#include "device/shrc203/refusals.h"

namespace axisgate::shrc203 {
namespace {

constexpr Duration kEarly = std::chrono::milliseconds(5);    // a segment's end may be heard so much too soon
constexpr Duration kLate = std::chrono::milliseconds(100);   // how late before the prebuffer is asked
constexpr Duration kSegmentLost = std::chrono::seconds(10);  // a segment that has not ended by then never will
constexpr Duration kReadyPoll = std::chrono::milliseconds(60);

class PathRun {
 public:
  PathRun(Controller::Impl& owner, LiveMotionPtr motion, PathPlan plan)
      : impl_(owner), live_(std::move(motion)), plan_(std::move(plan)), reg_(plan_.reg()) {}

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

  Task<bool> start(int number);   // set and go, from READY
  Task<bool> refill(int number);  // false: the chain has ended, or is in doubt
  Task<bool> wait_for_segment_end();
  Task<std::optional<Held>> read_prebuffer();
  Task<bool> prebuffer_left();
  Task<void> stop_wrong_segment();
  Task<void> resume_from_ready();
  Task<bool> wait_for_ready();
  void keep_line_free(TimePoint due);
  void release_line() { impl_.line_.release(live_->motion.id, impl_.now_); }
  void note_speed(int number);
  bool completion_counts(const LiveMotion::Completion& completion);

  Controller::Impl& impl_;
  LiveMotionPtr live_;
  PathPlan plan_;
  Register reg_;
  int running_ = 0;     // the segment that moves
  int sent_ = 0;        // the last one that the controller accepted
  int clock_axis_ = 0;  // the first axis to answer in segment 1; the others' numbers are not counted
  int missed_ = 0;      // ends that were asked for because their number had not come; it may still
  TimePoint segment_began_{};
};

void PathRun::tell(PathProgress::Step step, int number, std::string reply) {
  if (step == PathProgress::Step::done) live_->motion.segments_done = number;
  if (step == PathProgress::Step::underrun) ++live_->motion.underruns;
  impl_.emit(PathProgress{live_->motion.id, step, number, std::move(reply)});
}

void PathRun::keep_line_free(TimePoint due) {
  if (impl_.profile_.refills == Refills::reserved) impl_.line_.keep_free(live_->motion.id, due, impl_.now_);
}

void PathRun::note_speed(int number) {
  const auto& first = segment(number).move.axes.front();
  if (first.speed) impl_.note_speeds({{first.axis, *first.speed}});
}

Task<void> PathRun::run() {
  const bool started = co_await start(1);
  if (!started) co_return;
  while (!over() && !live_->stop_requested && !live_->line_lost) {
    if (sent_ < count()) {
      const bool chained = co_await refill(sent_ + 1);
      if (over() || live_->stop_requested || live_->line_lost) break;
      if (!chained) {
        co_await resume_from_ready();
        continue;
      }
    }
    if (running_ == sent_) break;  // the last segment runs: READY will end it
    const bool ended = co_await wait_for_segment_end();
    if (!ended) break;
    tell(PathProgress::Step::done, running_);
    ++running_;
    segment_began_ = impl_.now_;
    tell(PathProgress::Step::started, running_);
  }
  release_line();
  if (over()) co_return;
  live_->completed = {};  // of the segments before; the last one's are still to come
  live_->on_success = [this] { tell(PathProgress::Step::done, count()); };
  co_await impl_.watch(live_, false);
}

Task<bool> PathRun::start(int number) {
  const auto set = co_await impl_.set_and_confirm(live_, setter(number), Lane::path_refill);
  if (!set) {
    give_up(live_->stop_requested ? MotionState::stopped : MotionState::failed, set.error());
    co_return false;
  }
  note_speed(number);
  tell(PathProgress::Step::sent, number, set->text);
  if (number < count()) keep_line_free(impl_.now_);  // the next segment is set as soon as this one runs
  const auto gone = co_await impl_.go(live_, plan_.axes);
  if (!gone) {
    give_up(live_->stop_requested ? MotionState::stopped : MotionState::failed, gone.error());
    co_return false;
  }
  running_ = sent_ = number;
  segment_began_ = impl_.now_;
  live_->completions.clear();
  if (*gone == Controller::Impl::Start::in_doubt) {
    co_await resume_from_ready();
    co_return !over();
  }
  tell(PathProgress::Step::started, number);
  co_return true;
}

Task<bool> PathRun::refill(int number) {
  auto pending = impl_.line_.exchange(impl_.motion_request(*live_, setter(number), refill_lane()), impl_.now_);
  if (number < count()) {
    keep_line_free(segment_began_ + segment(running_).shortest);
  } else {
    release_line();
  }
  const auto result = co_await pending;
  if (result.accepted()) {
    note_speed(number);
    tell(PathProgress::Step::sent, number, result.reply->text);
    if (result.reply->kind == Reply::Kind::ok_d || !guarded(Guard::underruns_told)) {
      sent_ = number;
      co_return true;
    }
    tell(PathProgress::Step::underrun, number);
    co_return false;
  }
  if (result.refused()) {
    const auto why = co_await impl_.explain_refusal(setter(number), plan_.axes, live_->context.who);
    const bool standing = co_await wait_for_ready();
    if (standing && !over()) give_up(live_->stop_requested ? MotionState::stopped : MotionState::failed, why);
  }
  co_return false;
}

// The number that ends a segment is believed when it comes neither too soon nor out of a barrier, and none is missing.
bool PathRun::completion_counts(const LiveMotion::Completion& completion) {
  if (clock_axis_ == 0) clock_axis_ = completion.axis;
  return completion.axis == clock_axis_ || !guarded(Guard::one_axis_is_the_clock);
}

Task<bool> PathRun::wait_for_segment_end() {
  const SegmentPlan& now_running = segment(running_);
  TimePoint ask_at = segment_began_ + now_running.longest + kLate;
  const TimePoint lost_at = ask_at + kSegmentLost;
  while (!live_->stop_requested && !live_->line_lost) {
    while (live_->completions.empty() && impl_.now_ < ask_at && !live_->stop_requested && !live_->line_lost) {
      auto news = live_->news.wait_until(ask_at);
      co_await news;
    }
    if (!live_->completions.empty()) {
      const auto completion = live_->completions.front();
      live_->completions.pop_front();
      if (!completion_counts(completion)) continue;
      const bool early =
          completion.at < segment_began_ + now_running.shortest - kEarly && guarded(Guard::early_numbers_checked);
      const bool doubtful = completion.doubtful && guarded(Guard::doubtful_numbers_checked);
      const bool missed = missed_ > 0 && guarded(Guard::missed_numbers_counted);
      if (!early && !doubtful && !missed) co_return true;
      if (missed_ > 0 && !completion.doubtful) --missed_;
    } else {
      ++missed_;
    }
    const bool left = co_await prebuffer_left();
    if (left) co_return true;
    if (impl_.now_ >= lost_at) {
      give_up(MotionState::unknown, Problem{Reason::outcome_unknown,
                                            fmt::format("segment {} did not end in the time it needs", running_),
                                            "look at the positions, and stop the axes",
                                            {},
                                            {},
                                            {}});
      co_return false;
    }
    if (impl_.now_ >= ask_at) {
      --missed_;
      ask_at = impl_.now_ + kLate;
    }
  }
  co_return false;
}

// What the prebuffer holds, compared with the segment sent last; nothing when nobody can tell.
Task<std::optional<Held>> PathRun::read_prebuffer() {
  const std::string_view question = reg_ == Register::kp ? "?:KP" : reg_ == Register::mp ? "?:MP" : "?:AP";
  const auto answer = co_await impl_.ask(question, Lane::path_refill, live_->context.who);
  if (!answer.reply || answer.problem || answer.reply->kind != Reply::Kind::data) co_return std::nullopt;
  co_return held(*answer.reply, setter(sent_), impl_.state_.controllable());
}

// Whether the segment that waited in the prebuffer has gone over into execution.
Task<bool> PathRun::prebuffer_left() {
  auto found = co_await read_prebuffer();
  if (found == Held::other && guarded(Guard::wrong_segments_stop)) {
    // Which axes it moves, and completes, nobody knows. The answer itself may have been misread.
    impl_.line_.completions().chained(AxisSet::all(), impl_.now_);
    found = co_await read_prebuffer();
    if (found == Held::other) co_await stop_wrong_segment();
  }
  co_return found == Held::nothing;
}

Task<void> PathRun::stop_wrong_segment() {
  const RequestContext gateway{
      .who = "the gateway, since the line changed a segment", .request_id = {}, .not_after = {}};
  impl_.stop(AxisSet::all(), false, gateway, [](const StopReport&) {});
  co_await wait_for_ready();
  if (over()) co_return;
  give_up(MotionState::failed, Problem{Reason::line_fault,
                                       fmt::format("segment {} was received wrongly, and all axes were stopped", sent_),
                                       "check the cable and the line settings, and look at the positions",
                                       {},
                                       setter(sent_).line,
                                       {}});
}

Task<bool> PathRun::wait_for_ready() {
  int ready = 0;
  Positions last;
  while (ready < 2 && !live_->line_lost) {
    const auto read = co_await impl_.read_positions(Lane::motion, live_->context.who);
    bool busy = !read.has_value();
    for (const int axis : plan_.axes.list()) busy = busy || impl_.state_.axis(axis).busy.value_or(true);
    const Positions here = impl_.places_of(*live_);
    ready = busy ? 0 : here == last ? ready + 1 : 1;
    last = here;
    if (ready >= 2) break;
    auto pause = impl_.tick_.wait_until(impl_.now_ + kReadyPoll);
    co_await pause;
  }
  co_return !live_->line_lost;
}

// The counters at READY say which segment was the last to run; the path goes on with the next.
Task<void> PathRun::resume_from_ready() {
  release_line();
  auto pause = impl_.tick_.wait_until(impl_.now_ + 3 * kReadyPoll);
  co_await pause;
  const bool standing = co_await wait_for_ready();
  if (!standing || live_->stop_requested) co_return;
  const auto error = error_shown(live_->motion.axes, impl_.state_);
  if (error) {
    give_up(MotionState::failed, *error);
    co_return;
  }
  int done = -1, matches = 0;
  for (int candidate = std::max(0, running_ - 1); candidate <= std::min(sent_ + 1, count()); ++candidate) {
    const auto& end = candidate == 0 ? plan_.begin : segment(candidate).end;
    bool here = true;
    for (const int axis : plan_.axes.list()) {
      here = here && impl_.state_.axis(axis).position_pulses == end[static_cast<std::size_t>(axis - 1)];
    }
    if (!here) continue;
    ++matches;
    done = candidate;
  }
  if (matches == 0 || (matches > 1 && guarded(Guard::path_place_is_unique))) {
    give_up(MotionState::unknown, Problem{Reason::outcome_unknown,
                                          "the path came to rest at a place that does not tell which segments ran",
                                          "look at the positions before moving on",
                                          {},
                                          {},
                                          {}});
    co_return;
  }
  for (int number = std::max(1, live_->motion.segments_done + 1); number <= done; ++number) {
    tell(PathProgress::Step::done, number);
  }
  running_ = sent_ = done;
  missed_ = 0;
  clock_axis_ = 0;
  if (done == count()) {
    impl_.end_motion(live_, MotionState::succeeded, {});
    co_return;
  }
  co_await start(done + 1);
}

}  // namespace

// Where the axes and their speeds are known, which they are not always before the gate has been passed.
Result<PathPlan> Controller::Impl::plan_feasible_path(const PathRequest& request) const {
  auto plan = plan_path(request, positions_of(state_), envelope(request.context));
  if (!plan || !known_speeds(AxisSet::of(plan->axes.lowest())).contains(plan->axes.lowest())) return plan;
  const auto feasible = check_feeding(*plan, line_.pace());
  if (!feasible) return tl::unexpected(feasible.error());
  return plan;
}

void Controller::Impl::run_path(PathRequest request, OnStarted started) {
  const auto plan = plan_feasible_path(request);
  if (!plan) {
    started(tl::unexpected(plan.error()));
    return;
  }
  if (const auto allowed = may_use(request.context, plan->axes); !allowed) {
    started(tl::unexpected(allowed.error()));
    return;
  }
  auto live = create_motion(MotionKind::path, plan->axes, request.context, std::move(started));
  live->motion.segments_total = static_cast<int>(plan->segments.size());
  executor_.spawn(run_path_motion(live, std::move(request), plan->reg()));
}

Task<void> Controller::Impl::run_path_motion(LiveMotionPtr live, PathRequest request, Register reg) {
  auto ready = co_await enter_gate(live, true);
  if (ready) ready = co_await prepare(live, reg);
  if (!ready) {
    end_motion(live, ready.error().reason == Reason::stopped ? MotionState::stopped : MotionState::failed,
               ready.error());
    co_return;
  }
  auto plan = plan_feasible_path(request);
  if (!plan) {
    end_motion(live, MotionState::failed, plan.error());
    co_return;
  }
  for (auto& result : live->motion.results) {
    result.target_pulses = plan->segments.back().end[static_cast<std::size_t>(result.axis - 1)];
  }
  const Speeds before = known_speeds(plan->axes);
  live->keeps_gate = std::ranges::any_of(
      plan->segments, [](const SegmentPlan& segment) { return segment.move.axes.front().speed.has_value(); });
  PathRun run(*this, live, *std::move(plan));
  co_await run.run();
  co_await restore_speeds(live, before);
}

}  // namespace axisgate::shrc203
