#include "device/shrc203/motion/path_run.h"

#include <fmt/format.h>

#include <algorithm>

#include "device/core/guard.h"
#include "device/shrc203/command/refusals.h"
#include "device/shrc203/limits.h"
#include "device/shrc203/planning/feeding.h"

namespace axisgate::shrc203 {

void PathRun::tell(PathProgress::Step step, int number, std::string reply) {
  if (live_->motion.kind != MotionKind::path) return;
  if (step == PathProgress::Step::done) live_->motion.segments_done = number;
  if (step == PathProgress::Step::underrun) ++live_->motion.underruns;
  impl_.emit(PathProgress{live_->motion.id, step, number, std::move(reply)});
}

void PathRun::keep_line_free(TimePoint due) {
  if (impl_.profile_.refills == Refills::reserved) impl_.line_.keep_free(live_->motion.id, due, impl_.now_);
}

void PathRun::note_speed(int number) { impl_.note_speeds(speeds_of(segment(number).move)); }

Task<void> PathRun::run() {
  bool going = co_await wait_before(1);
  if (going) going = co_await start(1);
  while (going && !over() && !live_->stop_requested && !live_->line_lost) {
    if (chains(sent_ + 1)) {
      const bool chained = co_await refill(sent_ + 1);
      if (over() || live_->stop_requested || live_->line_lost) break;
      if (!chained) {
        co_await resume_from_ready();
        continue;
      }
    }
    if (running_ == sent_) {
      if (sent_ == count()) break;  // the last segment runs: READY will end it
      co_await start_from_rest(sent_ + 1);
      continue;
    }
    const bool ended = co_await wait_for_segment_end();
    if (!ended) break;
    tell(PathProgress::Step::done, running_);
    ++running_;
    segment_began_ = impl_.now_;
    tell(PathProgress::Step::started, running_);
  }
  release_line();
  if (over()) co_return;
  live_->cut_short = running_ < count();
  live_->slack = segment(count()).slack;
  live_->ends_where_it_began = returns(count());
  live_->completed = {};  // of the segments before; the last one's are still to come
  live_->woken = false;
  live_->on_success = [this] { tell(PathProgress::Step::done, count()); };
  co_await impl_.watch(live_, false);
}

// A whole circle, or nearly one: within its slack, where it begins looks like its end.
bool PathRun::returns(int number) const {
  const auto& from = begin_of(number);
  return std::ranges::all_of(plan_.axes.list(), [&](int axis) {
    const auto place = static_cast<std::size_t>(axis - 1);
    return std::abs(segment(number).end[place] - from[place]) <= segment(number).slack;
  });
}

Task<bool> PathRun::start(int number) {
  const auto set = co_await impl_.set_and_confirm(live_, setter(number), Lane::path_refill);
  if (!set) {
    give_up(live_->stop_requested ? MotionState::stopped : MotionState::failed, set.error());
    co_return false;
  }
  note_speed(number);
  tell(PathProgress::Step::sent, number, set->text);
  if (chains(number + 1)) keep_line_free(impl_.now_);  // the next segment is set as soon as this one runs
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
  if (chains(number + 1)) {
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
  TimePoint ask_at = segment_began_ + now_running.longest + kCompletionLateMax;
  const TimePoint lost_at = ask_at + kSegmentEndLimit;
  while (!live_->stop_requested && !live_->line_lost) {
    while (live_->completions.empty() && impl_.now_ < ask_at && !live_->stop_requested && !live_->line_lost) {
      auto news = live_->news.wait_until(ask_at);
      co_await news;
    }
    if (!live_->completions.empty()) {
      const auto completion = live_->completions.front();
      live_->completions.pop_front();
      if (!completion_counts(completion)) continue;
      const bool early = completion.at < segment_began_ + now_running.shortest - kCompletionEarlyMax &&
                         guarded(Guard::early_numbers_checked);
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
      give_up(MotionState::unknown,
              Problem{.reason = Reason::outcome_unknown,
                      .message = fmt::format("segment {} did not end in the time it needs", running_),
                      .hint = "look at the positions, and stop the axes"});
      co_return false;
    }
    if (impl_.now_ >= ask_at) {
      --missed_;
      ask_at = impl_.now_ + kCompletionLateMax;
    }
  }
  co_return false;
}

// What the prebuffer holds, compared with the segment sent last; nothing when nobody can tell.
Task<std::optional<Held>> PathRun::read_prebuffer() {
  const auto question = commands::question_of(segment(sent_).reg());
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
  const RequestContext gateway{.who = "the gateway, since the line changed a segment"};
  impl_.stop(AxisSet::all(), false, gateway, [](const StopReport&) {});
  co_await wait_for_ready();
  if (over()) co_return;
  give_up(MotionState::failed,
          Problem{.reason = Reason::line_fault,
                  .message = fmt::format("segment {} was received wrongly, and all axes were stopped", sent_),
                  .hint = "check the cable and the line settings, and look at the positions",
                  .sent = setter(sent_).line});
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
    const bool here = candidate == 0 ? stands_at(plan_.begin, 0) : stands_at_end(candidate);
    if (!here) continue;
    ++matches;
    done = candidate;
  }
  if (matches == 0 || (matches > 1 && guarded(Guard::path_place_is_unique))) {
    give_up(MotionState::unknown,
            Problem{.reason = Reason::outcome_unknown,
                    .message = "the path came to rest at a place that does not tell which segments ran",
                    .hint = "look at the positions before moving on"});
    co_return;
  }
  for (int number = std::max(1, live_->motion.segments_done + 1); number <= done; ++number) {
    tell(PathProgress::Step::done, number);
  }
  running_ = sent_ = done;
  missed_ = 0;
  clock_axis_ = 0;
  if (done == count()) {
    if (live_->scan) co_await impl_.count_triggers(live_, false);
    impl_.end_motion(live_, MotionState::succeeded, {});
    co_return;
  }
  const bool good = co_await wait_before(done + 1);
  if (good) co_await start(done + 1);
}

}  // namespace axisgate::shrc203
