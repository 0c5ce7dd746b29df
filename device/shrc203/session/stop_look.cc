#include "device/shrc203/session/stop_look.h"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "device/core/guard.h"
#include "device/shrc203/limits.h"
#include "device/shrc203/session/program_status.h"

namespace axisgate::shrc203 {

// Reports whether readings count: those of another unit, or on a link that is not up, do not.
bool StopLook::counts(const StopJob& job) const {
  const bool same_unit = job.stop.serial_number.empty() || job.stop.serial_number == store_.state().serial_number;
  return store_.line_works() && same_unit;
}

Task<void> StopLook::look(StopJobPtr job) {
  const bool ready = co_await read(job);
  if (!job->open() || !counts(*job)) co_return;
  if (!ready) {
    job->stationary_looks = job->kept_looks = 0;
    job->stationary = false;
    if (std::exchange(job->kept_waiting, false)) job->write_at = tasks_.now();
    co_return;
  }
  if (job->stationary_looks++ == 0) job->rest_since = tasks_.now();
  job->stationary = true;
  if (!is_certain(*job)) co_return;
  const Prebuffers prebuffers = co_await read_prebuffers(job);
  if (!job->open() || !job->stationary || prebuffers != Prebuffers::empty || !counts(*job)) co_return;
  if (job->stop.kind == StopKind::emergency) {
    // A memory switch decides whether the motors stay excited (manual 66)).
    const auto excitation = co_await reader_.read_excitation(job->context.who);
    if (!excitation) store_.unsettle();
  }
  if (job->open() && job->stationary) confirm(job);
}

// Reports whether the readings are certain. One flipped bit turns a B into an R, and a start may show late, so one
// READY is enough only after a stop that was received.
bool StopLook::is_certain(const StopJob& job) const {
  return job.taken || job.stationary_looks > 1 || !guarded(Guard::stop_seen_twice);
}

void StopLook::confirm(const StopJobPtr& job) {
  for (const int axis : job->stop.axes.list()) {
    if (const auto position = store_.state().axis(axis).position_pulses) job->stop.came_to[axis] = *position;
  }
  open_.change(job, job->stop.state == StopState::asked ? StopEvent::returned_stationary : StopEvent::seen_stationary);
}

// Reads the state, and reports whether the axes are stationary and no program runs.
Task<bool> StopLook::read(StopJobPtr job) {
  const auto read = co_await reader_.read_positions(Lane::motion, job->context.who);
  if (!guarded(Guard::stop_confirmed_stationary)) co_return true;
  if (!read) co_return false;
  bool ready = true;
  for (auto& axis : job->report.axes) {
    axis.ready = !store_.state().axis(axis.axis).busy.value_or(true);
    axis.position_pulses = store_.state().axis(axis.axis).position_pulses;
    ready = ready && *axis.ready;
  }
  if (!ready) co_return false;
  const bool runs = co_await program_runs(*job);
  co_return !runs;
}

Task<bool> StopLook::program_runs(const StopJob& job) {
  if (!non_host_.in_program()) co_return false;
  const auto reported = co_await dialogue_.ask(Dialogue::Question::program, Lane::motion, job.context.who);
  const auto program = program_status(reported);
  co_return !program || program->runs();
}

// Reads the prebuffers: the manual does not say whether L: clears them (manual 65), 87)), and a remaining setpoint
// would run on the next start.
Task<StopLook::Prebuffers> StopLook::read_prebuffers(StopJobPtr job) {
  if (!guarded(Guard::stop_looks_at_prebuffer)) co_return Prebuffers::empty;
  auto reading = registers_.begin_reading();
  for (const Register reg : {Register::mp, Register::ap, Register::kp, Register::ep}) {
    const auto question = commands::question_of(reg);
    const auto answer = co_await dialogue_.ask(question, Lane::motion, job->context.who);
    if (!answer.reply || answer.problem) co_return Prebuffers::unknown;
    reading.take(reg, *answer.reply, store_.controllable());
    if (!reading.set().touches(job->excluded())) continue;
    note_kept(*job, answer, commands::text(question));
    co_return Prebuffers::kept;
  }
  open_.note_stale(*job, false);
  if (job->report.problem && job->report.problem->reason == Reason::stale_setpoint) job->report.problem.reset();
  co_return Prebuffers::empty;
}

// Notes a segment that the prebuffer has kept. It may start by itself, so the stop is written once more. After that
// only a reset helps.
void StopLook::note_kept(StopJob& job, const ExchangeResult& answer, std::string_view question) {
  if (++job.kept_looks == 1) {
    job.write_at = tasks_.now();
    return;
  }
  open_.note_stale(job, true);
  job.report.problem =
      Problem{.reason = Reason::stale_setpoint,
              .message = fmt::format(
                  "the axes were stopped, but {} reports that a stale setpoint is left in the controller", question),
              .hint = "reset the controller (RESET: or power) before moving these axes",
              .wire_reply = answer.reply->text};
}

}  // namespace axisgate::shrc203
