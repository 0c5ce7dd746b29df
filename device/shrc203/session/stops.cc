#include "device/shrc203/session/stops.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "device/core/guard.h"
#include "device/shrc203/limits.h"
#include "device/shrc203/session/program_status.h"

namespace axisgate::shrc203 {

void Stops::change(StopJob& job, StopEvent event) {
  const auto to = next(job.phase, event);
  if (!to) return violations_.illegal("stop", name(job.phase), name(event));
  job.phase = *to;
}

void Stops::stop(AxisSet axes, StopKind kind, const RequestContext& context, OnStopped done) {
  const AxisSet known = store_.controllable().empty() ? AxisSet::all() : store_.controllable();
  const AxisSet possible = axes & known;
  const AxisSet named = axes.empty() ? known : possible.empty() ? axes : possible;
  auto job = std::make_shared<StopJob>();
  job->axes = named;
  job->kind = kind;
  job->context = context;
  store_.emit(StopRequested{named, kind == StopKind::emergency, context.who});
  withdraw_motions(job->stops(), context);
  for (const auto& pending : jobs_) {
    if (guarded(Guard::stops_join) && pending->phase == StopPhase::writing && pending->kind == kind &&
        pending->axes.contains(named)) {
      return add_caller(pending, context, std::move(done));
    }
  }
  add_caller(job, context, std::move(done));
  for (const int axis : named.list()) job->report.axes.emplace_back().axis = axis;
  jobs_.push_back(job);
  motions_.gate().hold(job->stops());
  tasks_.spawn(run(job));
}

void Stops::add_caller(const StopJobPtr& job, const RequestContext& context, OnStopped done) {
  job->done.push_back(std::move(done));
  if (context.answer_by) tasks_.spawn(answer_at(job, job->done.size() - 1, *context.answer_by));
}

// Once. What was seen is the outcome, whatever became of the reply; before that the outcome is unknown.
void Stops::answer(StopJob& job, std::size_t caller) {
  const OnStopped done = std::exchange(job.done[caller], {});
  if (!done) return;
  StopReport report = job.report;
  const bool in_doubt = report.problem && report.problem->reason == Reason::outcome_unknown;
  if (job.stationary && in_doubt) report.problem.reset();
  if (!job.stationary && !report.problem) {
    report.problem = Problem{.reason = Reason::outcome_unknown,
                             .message = "the axes were not confirmed stationary in the time allowed",
                             .hint = "check with `axisctl status`; use the wired emergency stop if they move"};
  }
  done(std::move(report));
}

// The stop itself continues.
Task<void> Stops::answer_at(StopJobPtr job, std::size_t caller, TimePoint limit) {
  auto pause = tasks_.until(limit);
  co_await pause;
  answer(*job, caller);
}

// The queue of motion on these axes is emptied: what was not written never will be.
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

// In the edit modes nothing moves and no stop is taken (manual 111), 117)); a program is stopped by P:E (manual
// 107)).
bool Stops::has_no_use(StopJob& job) const {
  if (!non_host_.edits() || motions_.anything_moves() || !guarded(Guard::stop_off_host)) return false;
  job.report.problem = non_host_.problem();
  job.report.problem->hint = "nothing moves in it; use the wired emergency stop if something does";
  return true;
}

// In a non-host mode no stop is accepted and no position reported (manual 4., last note); the caller learns it at once.
Problem Stops::unseen() const {
  const State& state = store_.state();
  if (!state.mode.empty() && state.mode != "HOST" && guarded(Guard::stop_off_host)) {
    return {.reason = Reason::wrong_mode,
            .message = fmt::format("the controller is in {} mode, where it takes no stop from here", state.mode),
            .hint = "use the front panel, or the wired emergency stop"};
  }
  return {.reason = Reason::outcome_unknown,
          .message = "the stop was written, but its outcome is not known yet: " + state.link_problem,
          .hint = "use the front panel, or the wired emergency stop"};
}

Task<void> Stops::run(StopJobPtr job) {
  if (!has_no_use(*job)) co_await write(job);
  const bool written = !job->report.problem || job->report.problem->reason == Reason::outcome_unknown;
  const bool works = written && !non_host_.edits() && store_.line_works();
  change(*job, works ? StopEvent::answered : StopEvent::refused);
  if (written && !works) job->report.problem = unseen();
  if (works && guarded(Guard::stop_confirmed_stationary)) co_await wait_for_standstill(job);
  if (works && job->kind == StopKind::emergency) {
    // Whether the motors stay excited depends on a memory switch (manual 66)).
    const auto excitation = co_await reader_.read_excitation(job->context.who);
    if (!excitation) store_.unsettle();
  }
  if (works) change(*job, StopEvent::finished);
  std::erase(jobs_, job);
  motions_.gate().let_go(job->stops());
  for (std::size_t caller = 0; caller < job->done.size(); ++caller) answer(*job, caller);
}

Command Stops::command_for(const StopJob& job, AxisSet axes) const {
  if (job.kind == StopKind::emergency) return commands::emergency_stop();
  return non_host_.in_program() ? commands::stop_program() : commands::stop(axes);
}

Task<ExchangeResult> Stops::write_line(StopJobPtr job, Command command) {
  ExchangeRequest request;
  request.command = std::move(command);
  request.lane = Lane::stop;
  request.caller = job->context.who;
  request.not_after = tasks_.now() + (store_.state().link == LinkState::down ? kStopReopenLimit : kStopWriteLimit);
  auto pending = dialogue_.exchange(std::move(request));
  auto result = co_await pending;
  co_return result;
}

// What is known of the excitation may be old: where no motor seems to be on, the controller is to say.
AxisSet Stops::excited(const StopJob& job) const {
  AxisSet named = job.axes;
  for (const int axis : job.axes.list()) {
    const bool off = !store_.state().axis(axis).excited.value_or(true) && guarded(Guard::stop_names_excited_axes);
    if (job.kind != StopKind::emergency && off) named.remove(axis);
  }
  return named.empty() ? job.axes : named;
}

// A stop can be written twice without harm, so one that was not answered is written again.
Task<void> Stops::write(StopJobPtr job) {
  const AxisSet named = excited(*job);
  const Command all = command_for(*job, named);
  for (auto& axis : job->report.axes) axis.named = named.has(axis.axis);
  ExchangeResult result;
  for (int attempt = 0; attempt < kStopTries; ++attempt) {
    result = co_await write_line(job, all);
    const bool inside_barrier = result.problem && result.problem->reason == Reason::outcome_unknown;
    const bool received = result.received.value_or(false);
    if (result.reply || !result.written || inside_barrier || received || !guarded(Guard::stop_again)) break;
  }
  job->report.problem = result.problem;
  if (!result.written && result.problem) {
    job->report.problem->message = "the stop could not be written: " + result.problem->message;
    job->report.problem->hint = "use the wired emergency stop if the axes move";
  }
  const bool unreadable = result.in_doubt() && result.problem->reason == Reason::line_fault;
  // It was written: what is seen of the axes decides.
  if (result.in_doubt()) job->report.problem->reason = Reason::outcome_unknown;
  for (auto& axis : job->report.axes) {
    if (!axis.named) continue;
    if (result.reply) axis.wire_reply = result.reply->text;
    axis.reply_unreadable = unreadable;
  }
  if (!result.refused() || job->kind == StopKind::emergency || named.count() < 2) co_return;
  if (!guarded(Guard::stop_one_axis_at_a_time)) co_return;
  for (auto& axis : job->report.axes) {
    if (!axis.named) continue;
    const auto one = co_await write_line(job, commands::stop(AxisSet::of(axis.axis)));
    axis.wire_reply = one.reply ? one.reply->text : "";
  }
}

// How long the axes may take from F to S (manual 89) D:).
Duration Stops::slowing(AxisSet axes) const {
  int longest_ms = 0;
  for (const int axis : axes.list()) {
    longest_ms = std::max(longest_ms, store_.state().axis(axis).acceleration_ms.value_or(1000));
  }
  return std::chrono::milliseconds(longest_ms);
}

// Whether the axes, and a program, are seen to be stationary.
Task<bool> Stops::look(StopJobPtr job) {
  const auto read = co_await reader_.read_positions(Lane::motion, job->context.who);
  bool ready = read.has_value();
  for (auto& axis : job->report.axes) {
    if (!read) continue;
    axis.ready = !store_.state().axis(axis.axis).busy.value_or(true);
    axis.position_pulses = store_.state().axis(axis.axis).position_pulses;
    ready = ready && *axis.ready;
  }
  if (ready && non_host_.in_program()) {
    const auto reported = co_await dialogue_.ask(Dialogue::Question::program, Lane::motion, job->context.who);
    const auto program = program_status(reported);
    ready = program && !program->runs();
  }
  job->stationary = ready;
  co_return ready;
}

// A kept segment may start by itself, and a stop inside a barrier may be lost: it is written once more.
Task<bool> Stops::write_again(StopJobPtr job) {
  change(*job, StopEvent::ran_on);
  AxisSet named;
  for (const auto& axis : job->report.axes) {
    if (axis.named) named.add(axis.axis);
  }
  const Command again = command_for(*job, named);
  const auto stopped = co_await write_line(job, again);
  co_return stopped.written;
}

// What is still to be asked holds nobody up on a line that garbles the answers.
void Stops::answer_soon(const StopJobPtr& job) {
  for (std::size_t caller = 0; caller < job->done.size(); ++caller) {
    tasks_.spawn(answer_at(job, caller, tasks_.now() + kStopAnswerLimit));
  }
}

Task<void> Stops::wait_for_standstill(StopJobPtr job) {
  const TimePoint limit = tasks_.now() + kStopStationaryLimit;
  const TimePoint again_at = tasks_.now() + slowing(job->axes) + kStopRepeatAfterSlowing;
  bool ready = false;
  while (tasks_.now() < limit && store_.state().link != LinkState::down) {
    ready = co_await look(job);
    const bool once_more = job->phase == StopPhase::slowing;
    if (ready) answer_soon(job);
    const bool runs_on = !ready && tasks_.now() >= again_at && guarded(Guard::stop_again);
    if (ready || (runs_on && once_more)) {
      const bool empty = !runs_on && co_await prebuffer_is_empty(job);
      if (empty || !once_more) break;
      ready = false;
      const bool written = co_await write_again(job);
      if (!written) break;
    }
    auto pause = tasks_.pause(kStopStationaryPoll);
    co_await pause;
  }
}

// Whether L: clears the prebuffer is not documented (manual 65), 87)); what it left would run on the next start.
Task<bool> Stops::prebuffer_is_empty(StopJobPtr job) {
  if (!guarded(Guard::stop_looks_at_prebuffer)) co_return true;
  auto reading = registers_.begin_reading();
  for (const Register reg : {Register::mp, Register::ap, Register::kp, Register::ep}) {
    const auto question = commands::question_of(reg);
    const auto answer = co_await dialogue_.ask(question, Lane::motion, job->context.who);
    if (!answer.reply || answer.problem) co_return true;  // not known; the registers stay unknown
    reading.take(reg, *answer.reply, store_.controllable());
    if (!reading.set().touches(job->stops())) continue;
    job->report.problem = Problem{
        .reason = Reason::stale_setpoint,
        .message = fmt::format("the axes were stopped, but {} reports that a stale setpoint is left in the controller",
                               commands::text(question)),
        .hint = "reset the controller (RESET: or power) before moving these axes",
        .wire_reply = answer.reply->text};
    co_return false;
  }
  if (job->report.problem && job->report.problem->reason == Reason::stale_setpoint) job->report.problem.reset();
  co_return true;
}

void Stops::cancel(MotionId id, const RequestContext& context, OnDone done) {
  const auto live = motions_.find_live(id);
  if (!live) {
    return done(motions_.find(id)
                    ? Result<void>()
                    : fail(Reason::not_found, fmt::format("there is no motion {}", id), "see `axisctl status`"));
  }
  if (live->life.has_turn()) {
    return stop(live->motion.axes, StopKind::stop, context, [done](const StopReport& report) {
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
