#include "device/shrc203/session/stops.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "device/core/guard.h"
#include "device/shrc203/limits.h"

namespace axisgate::shrc203 {

void Stops::stop(AxisSet axes, StopKind kind, const RequestContext& context, OnStopped done) {
  const AxisSet known = store_.controllable().empty() ? kAllAxes : store_.controllable();
  const AxisSet possible = axes & known;
  const AxisSet named = axes.empty() ? known : possible.empty() ? axes & kAllAxes : possible;
  const bool emergency = kind == StopKind::emergency;
  const bool moved = motions_.anything_moves() || !motions_.live().empty() || store_.state().moving_unknown;
  store_.emit(StopRequested{named, emergency, context.who, moved});
  if (emergency) open_.latch(context.who);
  withdraw_motions(emergency ? kAllAxes : named, context);
  StopJobPtr job = guarded(Guard::stops_join) ? open_.including(named, kind) : nullptr;
  if (!job) {
    job = begin(named, kind, context);
  } else if (job->taken) {
    job->write_at = tasks_.now();  // a caller who asks again has a reason
  }
  add_caller(job, named, context, std::move(done));
  line_.open_at_once(tasks_.now());
  due_.notify();
}

StopJobPtr Stops::begin(AxisSet axes, StopKind kind, const RequestContext& context) {
  auto job = open_.open(axes, kind, context);
  motions_.gate().hold(job->excluded());
  if (guarded(Guard::wider_stop_replaces)) replace_narrower(job);
  tasks_.spawn(carry_out(job));
  return job;
}

// Ends the stops that the wider one includes. Their callers then wait for the wider one.
void Stops::replace_narrower(const StopJobPtr& wider) {
  for (const StopJobPtr& job : open_.all()) {
    const bool emergency = wider->stop.kind == StopKind::emergency;
    const bool includes = job->stop.kind == StopKind::stop && wider->excluded().contains(job->stop.axes);
    if (job == wider || (!includes && !(emergency && job->stop.kind == StopKind::stop))) continue;
    for (const std::string& who : job->stop.callers) open_.note_caller(*wider, who);
    for (StopJob::Caller& caller : job->callers) {
      if (!caller.done) continue;
      wait_with(wider, {caller.axes, caller.asked, caller.answer_by, std::exchange(caller.done, {})});
    }
    wider->stop.late = wider->stop.late || job->stop.late;
    job->stop.replaced_by = wider->stop.id;
    open_.change(job, StopEvent::widened);
    seen_.notify();
  }
}

void Stops::add_caller(const StopJobPtr& job, AxisSet axes, const RequestContext& context, OnStopped done) {
  wait_with(job, {axes, tasks_.now(), context.answer_by, std::move(done)});
  open_.note_caller(*job, context.who);
}

void Stops::wait_with(const StopJobPtr& job, StopJob::Caller caller) {
  job->callers.push_back(std::move(caller));
  ++answering_;
  tasks_.spawn(answer_in_time(job, job->callers.size() - 1));
}

void Stops::inherit(const stage::Inheritance& left) {
  if (left.emergency) open_.inherit(*left.emergency);
  for (const StopJobPtr& job : open_.inherit(left.open_stops, left.last_stop)) {
    job->write_at = TimePoint::max();
    motions_.gate().hold(job->excluded());
    tasks_.spawn(carry_out(job));
  }
}

// Withdraws the motions on these axes: lines not written yet never will be.
void Stops::withdraw_motions(AxisSet axes, const RequestContext& context) {
  const auto stopped = motions_.stop_asked(axes, context.who);
  const auto is_stopped = [&stopped](MotionId id) { return std::ranges::find(stopped, id) != stopped.end(); };
  const Problem problem{.reason = Reason::stopped,
                        .message = fmt::format("a stop by {} came before the motion was sent", context.who),
                        .hint = "ask again if the motion is still wanted"};
  if (guarded(Guard::stop_withdraws_motions)) motions_.gate().withdraw(is_stopped, problem);
  const auto is_theirs = [&](const ExchangeRequest& request) { return is_stopped(request.motion); };
  if (guarded(Guard::stop_withdraws_lines)) line_.withdraw(is_theirs, problem);
  store_.unsettle();
}

Task<void> Stops::carry_out(StopJobPtr job) {
  bool first = true;
  while (job->open()) {
    if (writer_.takes_none()) job->kept_waiting = true;
    const bool due = tasks_.now() >= job->write_at && !job->kept_waiting;
    const bool may = first || guarded(Guard::stop_stays_open);
    if (due && may && writer_.can_write()) co_await writer_.write(job);
    first = false;
    if (job->open() && store_.line_works() && !writer_.takes_none()) co_await look_.look(job);
    seen_.notify();
    if (!job->open()) break;
    auto due_now = due_.wait_until(next_step(*job));
    co_await due_now;
  }
  motions_.gate().let_go(job->excluded());
  seen_.notify();
}

void Stops::wake() {
  due_.notify();
  seen_.notify();
}

TimePoint Stops::next_step(const StopJob& job) const {
  const TimePoint now = tasks_.now();
  const bool lasts =
      !store_.line_works() || job.stop.stale || (job.stop.late && now - job.stop.asked > kStopStationaryLimit);
  return now + (lasts ? kStopLastingPoll : kStopStationaryPoll);
}

void Stops::barrier_entered() { writer_.barrier_entered(); }

void Stops::line_answers() {
  writer_.line_answers();
  wake();
}

void Stops::line_lost() {
  writer_.line_lost();
  wake();
}

void Stops::axes_move() {
  for (const StopJobPtr& job : open_.all()) {
    if (std::exchange(job->kept_waiting, false)) job->write_at = tasks_.now();
  }
  wake();
}

// Reports whether the stop is over: the axes are stationary, their motion has an outcome and has left them. The answers
// of GetMotion and AcquireLease then agree with the stop's.
bool Stops::is_over(const StopJob& job) const {
  return !job.open() && (!motions_.occupied().touches(job.excluded()) || !guarded(Guard::stop_awaits_outcomes));
}

Task<void> Stops::answer_in_time(StopJobPtr job, std::size_t caller) {
  while (job->callers[caller].done && !is_over(*job)) {
    const TimePoint limit = limit_of(*job, job->callers[caller]);
    if (tasks_.now() >= limit) break;
    auto seen = job->open() ? seen_.wait_until(limit) : motions_.ended_or_left().wait_until(limit);
    co_await seen;
  }
  --answering_;
  answer(*job, caller);
}

TimePoint Stops::limit_of(const StopJob& job, const StopJob::Caller& caller) const {
  TimePoint limit = caller.asked + kStopStationaryLimit;
  if (job.open()) {
    if (writer_.takes_none() || job.stop.stale) limit = caller.asked;
    // Questions after the axes are stationary must not delay the answer on a line that garbles them.
    const bool occupied = motions_.occupied().touches(job.excluded());
    if (job.stationary) limit = std::min(limit, job.rest_since + (occupied ? 2 : 1) * kStopAnswerLimit);
    if (!store_.line_works()) limit = std::min(limit, caller.asked + kStopReopenLimit);
  }
  return caller.answer_by ? std::min(limit, *caller.answer_by) : limit;
}

// Answers the caller once. The outcome is what was seen, whatever became of the reply; it is unknown before that.
void Stops::answer(StopJob& job, std::size_t caller) {
  const OnStopped done = std::exchange(job.callers[caller].done, {});
  if (!done) return;
  StopReport report = report_for(job, job.callers[caller]);
  if (report.stays_open) open_.note_late(job);
  done(std::move(report));
}

StopReport Stops::report_for(const StopJob& job, const StopJob::Caller& caller) const {
  StopReport report = job.report;
  report.stays_open = job.open();
  std::erase_if(report.axes, [&](const StopReport::Axis& axis) { return !caller.axes.has(axis.axis); });
  const AxisSet occupied = motions_.occupied();
  bool stationary = job.stationary || job.stop.state == StopState::confirmed;
  for (auto& axis : report.axes) {
    const bool moves = occupied.has(axis.axis) && guarded(Guard::stop_awaits_outcomes);
    if (moves || !stationary) stationary = false;
    if (moves && axis.ready.value_or(false)) axis.ready.reset();
  }
  if (!stationary && !report.problem) report.problem = unseen(job);
  return report;
}

// Returns the reason why the axes were not seen stationary. In a non-host mode no stop is accepted and no position
// reported (manual 4., last note); the caller receives this at once.
Problem Stops::unseen(const StopJob& job) const {
  constexpr const char* kHint = "use the front panel, or the wired emergency stop, if the axes move";
  if (job.stop.state == StopState::withdrawn) {
    return {
        .reason = Reason::outcome_unknown,
        .message = fmt::format("the stop was withdrawn by {}; nobody has seen the axes obey it", job.stop.withdrawn_by),
        .hint = kHint};
  }
  const State& state = store_.state();
  if (writer_.takes_none()) {
    return {.reason = Reason::wrong_mode,
            .message = fmt::format("the controller is in {} mode, where it takes no stop; the stop is sent when it is "
                                   "back in HOST mode and an axis moves",
                                   state.mode.empty() ? "another" : state.mode),
            .hint = kHint};
  }
  const bool written = job.stop.state == StopState::written;
  if (!store_.line_works()) {
    return {.reason = Reason::outcome_unknown,
            .message = fmt::format(
                "the stop was {} and stays open: it is sent {} as soon as the controller answers; its outcome "
                "is not known: {}",
                written ? "written" : "not written yet", written ? "again" : "first", store_.link_problem()),
            .hint = kHint};
  }
  return {.reason = Reason::outcome_unknown,
          .message = "the axes were not confirmed stationary in the time allowed; the stop stays open and is repeated",
          .hint = kHint};
}

void Stops::withdraw(StopId id, const RequestContext& context, const OnDone& done) {
  const StopJobPtr job = open_.find(id);
  if (!job) return done(fail(Reason::not_found, fmt::format("stop {} is not open", id), "see `GetDevice`"));
  job->stop.withdrawn_by = context.who;
  open_.change(job, StopEvent::abandoned);
  wake();
  done({});
}

void Stops::cancel(MotionId id, const RequestContext& context, OnDone done) {
  const auto live = motions_.find_live(id);
  const AxisSet left = live ? AxisSet() : motions_.left_moving(id);
  if (!live && left.empty()) {
    return done(motions_.find(id)
                    ? Result<void>()
                    : fail(Reason::not_found, fmt::format("there is no motion {}", id), "see `GetDevice`"));
  }
  if (!live || live->life.has_turn()) {
    return stop(live ? live->motion.axes : left, StopKind::stop, context, [done](const StopReport& report) {
      done(report.problem ? Result<void>(tl::unexpected(*report.problem)) : Result<void>());
    });
  }
  motions_.stop_asked(*live, context.who);
  motions_.gate().withdraw(
      [id](MotionId waiting) { return waiting == id; },
      {.reason = Reason::stopped, .message = "cancelled by " + context.who + " before it was sent"});
  done({});
}

}  // namespace axisgate::shrc203
