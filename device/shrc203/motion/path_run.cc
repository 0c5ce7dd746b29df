#include "device/shrc203/motion/path_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "device/core/guard.h"
#include "device/shrc203/command/refusals.h"
#include "device/shrc203/limits.h"

namespace axisgate::shrc203 {

void PathRun::change(SegmentEvent event) {
  const auto to = next(phase_, event);
  if (!to) return parts_.violations.illegal("segment", name(phase_), name(event));
  phase_ = *to;
}

void PathRun::tell(PathProgress::Step step, int number, std::string reply) {
  if (live_->motion.kind != MotionKind::path) return;
  if (step == PathProgress::Step::done) live_->motion.segments_done = number;
  if (step == PathProgress::Step::underrun) ++live_->motion.underruns;
  parts_.store.emit(PathProgress{live_->motion.id, step, number, std::move(reply)});
}

Lane PathRun::refill_lane() const {
  return parts_.store.profile().refills == Refills::among_questions ? Lane::question : Lane::path_refill;
}

void PathRun::keep_line_free(TimePoint due) {
  if (parts_.store.profile().refills != Refills::reserved) return;
  parts_.line.keep_free(live_->motion.id, due, parts_.tasks.now());
}

Task<void> PathRun::run() {
  bool going = co_await wait_before(1);
  if (going) going = co_await start(1);
  while (going && !over() && !interrupted()) going = co_await advance();
  release_line();
  if (!over()) co_await watch_end();
}

Task<bool> PathRun::advance() {
  if (!chains(running_ + 1)) {
    if (running_ == count()) co_return false;  // the last segment runs and ends at READY
    co_await start_from_rest(running_ + 1);
    co_return true;
  }
  co_await refill(running_ + 1);
  if (over() || interrupted()) co_return false;
  if (phase_ == SegmentPhase::doubtful) {
    co_await resume_from_ready();
    co_return true;
  }
  const bool ended = co_await wait_for_segment_end();
  if (!ended) co_return false;
  tell(PathProgress::Step::done, running_);
  ++running_;
  change(SegmentEvent::ended);
  segment_began_ = parts_.tasks.now();
  tell(PathProgress::Step::started, running_);
  co_return true;
}

Task<void> PathRun::watch_end() {
  live_->goal = running_ < count() ? Goal::none : returns(count()) ? Goal::round_trip : Goal::targets;
  live_->slack = segment(count()).slack;
  live_->completed = {};  // those of earlier segments; the last one's are still to come
  live_->on_success = [this] { tell(PathProgress::Step::done, count()); };
  co_await parts_.watch.run(live_, Start::accepted, live_->wake_ups);
}

// Reports whether the segment ends where it begins, within its slack: a whole circle, or nearly one.
bool PathRun::returns(int number) const {
  const Place& from = begin_of(number);
  return std::ranges::all_of(plan_.axes.list(), [&](int axis) {
    const auto place = static_cast<std::size_t>(axis - 1);
    return std::abs(segment(number).end[place] - from[place]) <= segment(number).slack;
  });
}

Task<bool> PathRun::wait_before(int number) {
  const SegmentHalt::Before before{number, begin_of(number), number == 1 ? 0 : segment(number - 1).slack};
  const bool good = co_await parts_.halt.wait(live_, segment(number), before);
  if (!good) co_return false;
  missed_ = 0;
  clock_axis_ = 0;
  live_->completions.clear();
  co_return true;
}

Task<bool> PathRun::start(int number) {
  change(SegmentEvent::set_asked);
  const auto set = co_await parts_.starter.set_and_confirm(live_, setter(number), Lane::path_refill);
  if (!set) {
    parts_.motions.disconnect(*live_, set.error());
    co_return false;
  }
  parts_.store.note_speeds(speeds_of(segment(number).move));
  tell(PathProgress::Step::sent, number, set->text);
  if (chains(number + 1)) keep_line_free(parts_.tasks.now());  // the next segment is set as soon as this one runs
  const auto gone = co_await parts_.starter.go(live_, plan_.axes);
  if (!gone) {
    parts_.motions.disconnect(*live_, gone.error());
    co_return false;
  }
  running_ = number;
  segment_began_ = parts_.tasks.now();
  live_->completions.clear();
  if (*gone == Start::in_doubt) {
    change(SegmentEvent::start_doubted);
    co_await resume_from_ready();
    co_return !over();
  }
  change(SegmentEvent::start_accepted);
  tell(PathProgress::Step::started, number);
  co_return true;
}

Task<void> PathRun::refill(int number) {
  change(SegmentEvent::refill_asked);
  auto pending = parts_.dialogue.exchange(parts_.dialogue.request_of(*live_, setter(number), refill_lane()));
  if (chains(number + 1)) {
    keep_line_free(segment_began_ + segment(running_).shortest);
  } else {
    release_line();
  }
  const auto result = co_await pending;
  if (result.accepted()) {
    parts_.store.note_speeds(speeds_of(segment(number).move));
    tell(PathProgress::Step::sent, number, result.reply->text);
    if (result.reply->kind == Reply::Kind::ok_d || !guarded(Guard::underruns_reported)) {
      change(SegmentEvent::refill_accepted);
      co_return;
    }
    tell(PathProgress::Step::underrun, number);
  }
  if (result.refused()) co_await refill_refused(number);
  change(SegmentEvent::refill_doubted);
}

Task<void> PathRun::refill_refused(int number) {
  const auto why = co_await parts_.explainer.explain(setter(number), plan_.axes, live_->context.who);
  const bool standing = co_await parts_.standstill.wait(live_);
  if (standing) parts_.motions.disconnect(*live_, why);
}

// Reports whether the completion is of the clock axis, whose completions end the segments.
bool PathRun::completion_counts(const LiveMotion::Completion& completion) {
  if (clock_axis_ == 0) clock_axis_ = completion.axis;
  return completion.axis == clock_axis_ || !guarded(Guard::one_axis_is_the_clock);
}

// Reports whether the completion certainly ends the running segment: it came neither too early nor in a barrier, and no
// earlier one is missing.
bool PathRun::is_believed(const LiveMotion::Completion& completion) {
  const bool early = completion.at < segment_began_ + segment(running_).shortest - kCompletionEarlyMax &&
                     guarded(Guard::early_numbers_checked);
  const bool doubtful = completion.doubtful && guarded(Guard::doubtful_numbers_checked);
  const bool missed = missed_ > 0 && guarded(Guard::missed_numbers_counted);
  if (!early && !doubtful && !missed) return true;
  if (missed_ > 0 && !completion.doubtful) --missed_;
  return false;
}

Task<bool> PathRun::wait_for_segment_end() {
  TimePoint ask_at = segment_began_ + segment(running_).longest + kCompletionLateMax;
  const TimePoint lost_at = ask_at + kSegmentEndLimit;
  while (!interrupted()) {
    while (live_->completions.empty() && parts_.tasks.now() < ask_at && !interrupted()) {
      auto changed = live_->changed.wait_until(ask_at);
      co_await changed;
    }
    if (live_->completions.empty()) {
      ++missed_;
    } else {
      const auto completion = live_->completions.front();
      live_->completions.pop_front();
      if (!completion_counts(completion)) continue;
      if (is_believed(completion)) co_return true;
    }
    const Prebuffer::Sent newest{sent(), setter(sent())};
    const bool left = co_await parts_.prebuffer.is_empty(live_, newest);
    if (left) co_return true;
    if (parts_.tasks.now() >= lost_at) {
      end(MotionState::unknown, Problem{.reason = Reason::outcome_unknown,
                                        .message = fmt::format("segment {} did not end in the time it needs", running_),
                                        .hint = "check the positions, and stop the axes"});
      co_return false;
    }
    if (parts_.tasks.now() >= ask_at) {
      --missed_;
      ask_at = parts_.tasks.now() + kCompletionLateMax;
    }
  }
  co_return false;
}

}  // namespace axisgate::shrc203
