// Stop goes first: L: and L:E, and what follows from them. Not a safety function.
#include <fmt/format.h>

#include <algorithm>

#include "device/core/guard.h"
#include "device/shrc203/controller_impl.h"
#include "device/shrc203/limits.h"

namespace axisgate::shrc203 {

void Controller::Impl::stop(AxisSet axes, bool emergency, const RequestContext& context, OnStopped done) {
  const AxisSet known = state_.controllable().empty() ? AxisSet::all() : state_.controllable();
  const AxisSet possible = axes & known;
  const AxisSet named = axes.empty() ? known : possible.empty() ? axes : possible;
  emit(StopRequested{named, emergency, context.who});
  flush_motions(named, context, emergency);
  for (const auto& pending : stops_) {
    if (guarded(Guard::stops_join) && !pending->answered && pending->emergency == emergency &&
        pending->axes.contains(named)) {
      pending->done.push_back(std::move(done));
      return;
    }
  }
  auto job = std::make_shared<StopJob>();
  job->axes = named;
  job->emergency = emergency;
  job->context = context;
  job->done.push_back(std::move(done));
  for (const int axis : named.list()) job->report.axes.push_back({axis, {}, false, {}, {}});
  stops_.push_back(job);
  gate_.hold(job->stops());
  executor_.spawn(run_stop(job));
}

// The queue of motion on these axes is emptied: what was not written never will be.
void Controller::Impl::flush_motions(AxisSet axes, const RequestContext& context, bool emergency) {
  AxisSet all = emergency ? AxisSet::all() : axes;
  std::vector<MotionId> stopped;
  for (const auto& [id, live] : live_) {
    if (!live->motion.axes.touches(all)) continue;
    live->stop_requested = true;
    live->stopped_by = context.who;
    live->woken = true;
    stopped.push_back(id);
    if (live->motion.state == MotionState::running) set_state(*live, MotionState::stopping);
    live->news.notify();
    if (live->jog) live->jog->news.notify();
  }
  const auto is_stopped = [&stopped](MotionId id) { return std::ranges::find(stopped, id) != stopped.end(); };
  const Problem problem{.reason = Reason::stopped,
                        .message = fmt::format("a stop by {} came before the motion was sent", context.who),
                        .hint = "ask again if the motion is still wanted"};
  if (guarded(Guard::stop_withdraws_motions)) gate_.withdraw(is_stopped, problem);
  const auto is_theirs = [&](const ExchangeRequest& request) { return is_stopped(request.motion); };
  if (guarded(Guard::stop_withdraws_lines)) line_.withdraw(is_theirs, problem);
  settled_ = false;
}

// In the edit modes nothing moves and no stop is taken (manual 111), 117)); a program is stopped by P:E (manual
// 107)).
bool Controller::Impl::stop_has_no_use(StopJob& job) const {
  if (!edits() || anything_moves() || !guarded(Guard::stop_off_host)) return false;
  job.report.problem = away_problem();
  job.report.problem->hint = "nothing moves in it; use the wired emergency stop if something does";
  return true;
}

Task<void> Controller::Impl::run_stop(StopJobPtr job) {
  if (!stop_has_no_use(*job)) co_await write_stop(job);
  job->answered = true;
  const bool written = !job->report.problem || job->report.problem->reason == Reason::outcome_unknown;
  const bool works = written && !edits() && line_works();
  if (written && !works) {
    // Off HOST no stop is taken and no position told (manual 4., last note); the caller hears so at once.
    const bool off_host = !state_.mode.empty() && state_.mode != "HOST" && guarded(Guard::stop_off_host);
    job->report.problem = Problem{
        .reason = off_host ? Reason::wrong_mode : Reason::outcome_unknown,
        .message = off_host ? fmt::format("the controller is in {} mode, where it takes no stop from here", state_.mode)
                            : "the stop was written, but nobody can tell yet what became of it: " + state_.link_problem,
        .hint = "use the front panel, or the wired emergency stop"};
  }
  if (works && guarded(Guard::stop_seen_to_stand)) co_await wait_for_standstill(job);
  if (works && job->emergency) {
    // Whether the motors stay excited depends on a memory switch (manual 66)).
    const auto excitation = co_await read_excitation(job->context.who);
    if (!excitation) settled_ = false;
  }
  std::erase(stops_, job);
  gate_.let_go(job->stops());
  for (auto& done : job->done) done(job->report);
}

Command Controller::Impl::stop_command(bool emergency, AxisSet axes) const {
  if (emergency) return commands::emergency_stop();
  return away_ == Mode::program ? commands::stop_program() : commands::stop(axes);
}

Task<ExchangeResult> Controller::Impl::write_stop_line(StopJobPtr job, Command command) {
  ExchangeRequest request;
  request.command = std::move(command);
  request.lane = Lane::stop;
  request.caller = job->context.who;
  request.not_after = now_ + (state_.link == LinkState::down ? kStopReopenLimit : kStopWriteLimit);
  auto pending = line_.exchange(std::move(request), now_);
  auto result = co_await pending;
  co_return result;
}

// A stop can be written twice without harm, so one that was not answered is written again.
Task<void> Controller::Impl::write_stop(StopJobPtr job) {
  AxisSet named = job->axes;
  for (const int axis : job->axes.list()) {
    const bool off = !state_.axis(axis).excited.value_or(true) && guarded(Guard::stop_names_excited_axes);
    if (!job->emergency && off) named.remove(axis);
  }
  if (named.empty()) named = job->axes;  // what is known of the excitation may be old: let the controller say
  const Command all = stop_command(job->emergency, named);
  ExchangeResult result;
  for (int attempt = 0; attempt < kStopTries; ++attempt) {
    result = co_await write_stop_line(job, all);
    const bool inside_barrier = result.problem && result.problem->reason == Reason::outcome_unknown;
    if (result.reply || !result.written || inside_barrier || !guarded(Guard::stop_again)) break;
  }
  job->report.problem = result.problem;
  if (!result.written && result.problem) {
    job->report.problem->message.insert(0, "the stop could not be written: ");
    job->report.problem->hint = "use the wired emergency stop if the axes move";
  }
  for (auto& axis : job->report.axes) {
    axis.named = named.has(axis.axis);
    if (axis.named && result.reply) axis.wire_reply = result.reply->text;
  }
  if (!result.refused() || job->emergency || named.count() < 2) co_return;
  if (!guarded(Guard::stop_one_axis_at_a_time)) co_return;
  for (auto& axis : job->report.axes) {
    if (!axis.named) continue;
    const auto one = co_await write_stop_line(job, commands::stop(AxisSet::of(axis.axis)));
    axis.wire_reply = one.reply ? one.reply->text : "";
  }
}

// How long the axes may take from F to S (manual 89) D:).
Duration Controller::Impl::slowing(AxisSet axes) const {
  int longest_ms = 0;
  for (const int axis : axes.list())
    longest_ms = std::max(longest_ms, state_.axis(axis).acceleration_ms.value_or(1000));
  return std::chrono::milliseconds(longest_ms);
}

Task<void> Controller::Impl::wait_for_standstill(StopJobPtr job) {
  const TimePoint limit = now_ + kStopStationaryLimit;
  const TimePoint again_at = now_ + slowing(job->axes) + kStopRepeatAfterSlowing;
  bool ready = false, once_more = true;
  while (now_ < limit && state_.link != LinkState::down) {
    const auto read = co_await read_positions(Lane::motion, job->context.who);
    ready = read.has_value();
    for (auto& axis : job->report.axes) {
      if (!read) continue;
      axis.ready = !state_.axis(axis.axis).busy.value_or(true);
      axis.position_pulses = state_.axis(axis.axis).position_pulses;
      ready = ready && *axis.ready;
    }
    if (ready && away_ == Mode::program) ready = co_await program_stands(job->context.who);
    const bool runs_on = !ready && now_ >= again_at && guarded(Guard::stop_again);
    if (ready || (runs_on && once_more)) {
      const bool empty = !runs_on && co_await prebuffer_is_empty(job);
      if (empty || !once_more) break;
      // A kept segment may start by itself, and a stop inside a barrier may be lost: stop once more and look again.
      once_more = false;
      ready = false;
      AxisSet named;
      for (const auto& axis : job->report.axes) {
        if (axis.named) named.add(axis.axis);
      }
      const Command again = stop_command(job->emergency, named);
      const auto stopped = co_await write_stop_line(job, again);
      if (!stopped.written) break;
    }
    auto pause = tick_.wait_until(now_ + kStopStationaryPoll);
    co_await pause;
  }
  if (ready && job->report.problem && job->report.problem->reason == Reason::outcome_unknown) {
    job->report.problem.reset();  // the state seen is the outcome
  } else if (!ready && !job->report.problem) {
    job->report.problem = Problem{.reason = Reason::outcome_unknown,
                                  .message = "the axes were not seen to stand still",
                                  .hint = "use the wired emergency stop if they move"};
  }
}

// Whether L: clears the prebuffer is not documented (manual 65), 87)); what it left would run on the next start.
Task<bool> Controller::Impl::prebuffer_is_empty(StopJobPtr job) {
  if (!guarded(Guard::stop_looks_at_prebuffer)) co_return true;
  auto reading = registers_.begin_reading();
  for (const Register reg : {Register::mp, Register::ap, Register::kp, Register::ep}) {
    const auto question = commands::question_of(reg);
    const auto answer = co_await ask(question, Lane::motion, job->context.who);
    if (!answer.reply || answer.problem) co_return true;  // cannot be told; the registers stay unknown
    reading.take(reg, *answer.reply, state_.controllable());
    if (!reading.set().touches(job->stops())) continue;
    job->report.problem = Problem{
        .reason = Reason::left_over_setting,
        .message = fmt::format("the axes were stopped, but {} tells that a prebuffer setting is left in the controller",
                               commands::text(question)),
        .hint = "reset the controller (RESET: or power) before moving these axes",
        .wire_reply = answer.reply->text};
    co_return false;
  }
  if (job->report.problem && job->report.problem->reason == Reason::left_over_setting) job->report.problem.reset();
  co_return true;
}

void Controller::Impl::cancel(MotionId id, const RequestContext& context, OnDone done) {
  const auto found = live_.find(id);
  if (found == live_.end()) {
    const bool ended = std::ranges::any_of(ended_, [id](const Motion& motion) { return motion.id == id; });
    done(ended ? Result<void>()
               : fail(Reason::not_found, fmt::format("there is no motion {}", id), "see `axisctl status`"));
    return;
  }
  const LiveMotionPtr live = found->second;
  if (live->inside_gate) {
    stop(live->motion.axes, false, context, [done](const StopReport& report) {
      done(report.problem ? Result<void>(tl::unexpected(*report.problem)) : Result<void>());
    });
    return;
  }
  live->stop_requested = true;
  live->stopped_by = context.who;
  gate_.withdraw([id](MotionId waiting) { return waiting == id; },
                 {.reason = Reason::stopped, .message = "cancelled by " + context.who + " before it was sent"});
  done({});
}

}  // namespace axisgate::shrc203
