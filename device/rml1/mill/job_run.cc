#include "device/rml1/mill/job_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "device/jobs/guard.h"
#include "device/rml1/sending/commands.h"

namespace axisgate::rml1 {
namespace {

// Returns the longest time until a raised tool is back in the place where it was raised: the travel at the top, the
// descent, and the spin-up of the spindle.
Duration longest_return(const Profile& profile, double slack) {
  const Duration across = longest_move(std::hypot(profile.x_mm, profile.y_mm), profile.speed.travel, profile, slack);
  const Duration down = longest_move(profile.z_mm, profile.speed.z_minimum, profile, slack);
  return across + down + std::chrono::duration_cast<Duration>(std::chrono::duration<double>(profile.spindle.spin_up_s));
}

tl::unexpected<Problem> refuse_paused(jobs::JobNumber job, std::string_view is, std::string_view hint) {
  return fail(Reason::wrong_job_state, fmt::format("job {} is {} already", job, is), std::string(hint));
}

}  // namespace

void JobRun::start(jobs::Job& job, std::shared_ptr<const PreparedJob> prepared, const use::RequestContext& by,
                   TimePoint now) {
  job.written.reset();
  job.executed.reset();
  set_plan(job, prepared->times().whole(), prepared->plan().run_on);
  queue_.change(job, jobs::JobEvent::start, by.who, "", now);
  rights_.job_begins(job, by, now);
  const PreparedJob& it = *prepared;
  run_.reset(new Run{.number = job.number,
                     .prepared = std::move(prepared),
                     .started = now,
                     .sender = Sender(it.text(), it.timeline(), profile_, it.settings(), it.plan(), mill_),
                     .left_at = now});
  run_->sender.start(now);
  follow_sender(now);
}

// A job whose tool was raised no longer runs: it is PAUSED in the queue.
Result<void> JobRun::check_sending(bool raise) const {
  switch (run_ ? run_->sender.state() : jobs::SenderState::ready) {
    case jobs::SenderState::sending:
    case jobs::SenderState::finishing:
      return {};
    case jobs::SenderState::paused:
      if (raise) return {};
      return refuse_paused(run_->number, "paused",
                           "`ResumeJob` continues it; `PauseJob` with `raise_tool` raises its tool");
    case jobs::SenderState::raising:
      return refuse_paused(run_->number, "being paused", "its tool goes up after what was sent");
    default:
      break;
  }
  const jobs::Job* const paused = queue_.first_in(jobs::JobState::paused);
  if (!run_ && paused != nullptr) {
    return refuse_paused(paused->number, "paused", "it continues once it is confirmed and started");
  }
  return fail(Reason::wrong_job_state, "no job is being sent", "`WatchMill` shows what the mill does");
}

Result<void> JobRun::check_pausable(bool raise, TimePoint now) {
  if (const Result<void> sending = check_sending(raise); !sending) return sending;
  const std::uint64_t written = prepared().of_body(run_->sender.progress(now).written);
  const bool has_rest = written < part_end(job());
  if (run_->sender.state() != jobs::SenderState::finishing && (has_rest || !raise)) return {};
  const bool last = is_last_part(job());
  return fail(Reason::wrong_job_state,
              fmt::format("the last byte of the {} has just been written", last ? "job" : "part that runs"),
              last ? "`AbortJob` ends it" : "its tool goes up by itself, and the job then waits for the next");
}

Result<void> JobRun::pause(bool raise, TimePoint now) {
  if (run_) run_->sender.advance(now);
  const Result<void> can = check_pausable(raise, now);
  if (can) raise ? run_->sender.raise() : run_->sender.pause();
  follow_sender(now);
  return can;
}

Result<void> JobRun::check_resumable() const {
  if (run_ && run_->sender.state() == jobs::SenderState::paused) return {};
  return fail(Reason::wrong_job_state, "no job is paused with the tool in the cut",
              "`GetMill` shows what the mill does; one that is PAUSED continues when it is confirmed and started");
}

void JobRun::resume(TimePoint now) {
  run_->sender.resume(now);
  follow_sender(now);
}

void JobRun::abort(std::string_view by, TimePoint now) {
  run_->aborted_by = by;
  note_executed(now);
  run_->sender.abort(now);
  follow_sender(now);
}

// Job::executed is set by the first abort only: bytes that are computed as executed after this abort may have been
// discarded by the mill.
void JobRun::note_executed(TimePoint now) {
  if (job().executed) return;
  const jobs::SendProgress progress = run_->sender.progress(now);
  job().executed = prepared().executed(run_->sender.executed_for_certain(now), progress.written);
}

void JobRun::line_lost(std::string_view why, TimePoint now) {
  if (!run_) return;
  run_->sender.line_lost();
  end(jobs::JobEvent::lost, "", why, now);
}

void JobRun::abandon(std::string_view why, TimePoint now) {
  if (!run_) return;
  job().written = written_at_loss();
  const jobs::JobNumber number = run_->number;
  run_.reset();
  rights_.job_ends(number, now);
  queue_.abandon(queue_.at(number), why, now);
}

void JobRun::about_to_write(std::size_t bytes, std::size_t unsent) {
  if (!run_ || run_->sender.state() != jobs::SenderState::sending) return;
  const std::uint64_t least = in_mill(run_->noted - std::min<std::uint64_t>(unsent, run_->noted));
  run_->noted += bytes;
  events_.about_to_write(run_->number, {prepared().of_body(least), prepared().of_body(run_->noted)});
}

std::optional<jobs::RunningJob> JobRun::view(TimePoint now) {
  return run_ ? std::optional(view_of_run(now)) : std::nullopt;
}

jobs::RunningJob JobRun::view_of_run(TimePoint now) {
  jobs::SendProgress progress = run_->sender.progress(now);
  const PreparedJob& sent = prepared();
  jobs::TimeRange left = left_of(sent, progress, run_->sender.measured_pace());
  left += takes_later(job());
  progress = {sent.of_body(progress.written), progress.unsent, sent.of_body(progress.taken),
              sent.of_body(progress.executed_least), sent.of_body(progress.executed_most)};
  return {.number = run_->number,
          .sender = run_->sender.state(),
          .progress = progress,
          .run_on = run_->sender.run_on(),
          .left = left,
          .started = run_->started,
          .busy = run_->busy};
}

void JobRun::follow_sender(TimePoint now) {
  if (!run_) return;
  judge_busy(now);
  const jobs::SenderState state = run_->sender.state();
  if (std::exchange(run_->seen, state) != state) events_.sender_changed(view_of_run(now), now);
  if (state == jobs::SenderState::fed) return end_fed_part(now);
  if (state == jobs::SenderState::raised) return end_raised(now);
  if (state == jobs::SenderState::aborted) end_aborted(now);
}

// A mill takes no bytes if it is paused at its panel, if it is off, or if its buffer is full. The line does not show
// which of these is true.
void JobRun::judge_busy(TimePoint now) {
  const jobs::SendProgress progress = run_->sender.progress(now);
  const std::uint64_t left = progress.written - progress.unsent;
  const jobs::SenderState state = run_->sender.state();
  const bool has_sent = state == jobs::SenderState::sending || state == jobs::SenderState::finishing ||
                        state == jobs::SenderState::raising;
  const bool has_more = progress.unsent > 0 || (has_sent && mill_.line.held());
  if (left != run_->left || !has_more) {
    run_->left = left;
    run_->left_at = now;
  }
  const bool busy = now - run_->left_at >= limits_.busy;
  if (std::exchange(run_->busy, busy) != busy) events_.sender_changed(view_of_run(now), now);
}

void JobRun::end_fed_part(TimePoint now) {
  if (const auto measured = run_->sender.measured_pace()) measured_pace_ = measured;
  if (is_last_part(job())) return end(jobs::JobEvent::fed, "", "", now);
  end(jobs::JobEvent::part_fed, "", fmt::format("the next tool is {}", job().parts[job().part + 1].tool), now);
}

// The rest must be confirmed like a job, because the tool is elsewhere and somebody may have reached into the machine.
void JobRun::end_raised(TimePoint now) {
  const std::uint64_t written = run_->sender.progress(now).written;
  const jobs::Place from = prepared().place(written);
  job().setup.from = from;
  jobs::TimeRange left = prepared().times().left(written, written);
  left.most += longest_return(profile_, prepared().plan().slack);
  set_plan(job(), left, run_->sender.run_on());
  job().written = jobs::WrittenRange{prepared().of_body(written), prepared().of_body(written)};
  end(jobs::JobEvent::raised, "",
      fmt::format("the tool is up; it continues at line {}, column {}", from.line, from.column), now);
}

// If the mill may have dropped the abort, it may still execute the job, so the job is PAUSED_UNKNOWN instead of
// ABORTED.
void JobRun::end_aborted(TimePoint now) {
  const bool unsure = run_->sender.abort_may_be_dropped();
  const std::string_view sent =
      unsure ? "the abort was sent, but the mill's buffer may have been full, and a full buffer drops it"
             : "the abort was sent";
  end(unsure ? jobs::JobEvent::abort_unsure : jobs::JobEvent::aborted, run_->aborted_by,
      fmt::format("{}; {}", sent, executed_text(job())), now);
}

void JobRun::end(jobs::JobEvent event, std::string_view by, std::string_view why, TimePoint now) {
  const std::string requested_by(by);  // copied, because `by` may refer to a string in run_
  jobs::Job& ended = job();
  // Keeps run_ for the recovery from this internal error.
  if (!next(ended.state, event)) return mill_.violations.illegal("job", name(ended.state), name(event));
  if (event == jobs::JobEvent::lost || event == jobs::JobEvent::abort_unsure) ended.written = written_at_loss();
  run_.reset();
  rights_.job_ends(ended.number, now);
  if (event == jobs::JobEvent::part_fed) go_to_part(ended, ended.part + 1);
  queue_.change(ended, event, requested_by, why, now);
}

// Returns how many of the `left` bytes that have left the host have certainly reached the mill. The other bytes may be
// in a converter, and are lost with the line.
std::uint64_t JobRun::in_mill(std::uint64_t left) const {
  const std::uint64_t converter = guarded(jobs::MillGuard::converter_in_range) ? limits_.converter : 0;
  return left - std::min(converter, left);
}

jobs::WrittenRange JobRun::written_at_loss() const {
  return {prepared().of_body(in_mill(run_->left)), prepared().of_body(run_->noted)};
}

void JobRun::advance(TimePoint now) {
  if (!run_) return;
  run_->sender.advance(now);
  follow_sender(now);
}

std::optional<TimePoint> JobRun::next_deadline(TimePoint now) const {
  if (!run_) return std::nullopt;
  const TimePoint look = now + kLook;
  return std::min(run_->sender.next_deadline(now).value_or(look), look);
}

std::string JobRun::broken_invariant() const {
  const jobs::Job* const running = queue_.first_in(jobs::JobState::running);
  if ((running == nullptr ? 0 : running->number) == number()) return "";
  return fmt::format("job {} runs, and the queue has job {} as the one that runs", number(),
                     running == nullptr ? 0 : running->number);
}

}  // namespace axisgate::rml1
