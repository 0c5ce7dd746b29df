// MillController: the abort, whether a job runs or none.
#include <fmt/format.h>

#include <string_view>

#include "device/rml1/guard.h"
#include "device/rml1/mill/mill_controller.h"
#include "device/rml1/sending/words.h"

namespace axisgate::rml1 {

bool MillController::abort(std::string_view by, TimePoint now) {
  events_.abort_requested(by, now);
  if (guarded(MillGuard::void_after_abort)) setup_changed("an abort", now);
  by_hand_until_ = now;
  rises_until_ = now + longest_way(profile_.z_mm, profile_.speed.z_maximum, profile_, settings_.sending.slack);
  if (!running_) return send_abort(now);
  running_->aborted_by = by;
  note_executed(now);
  running_->sender.abort(now);
  look_at_sender(now);
  return true;
}

// What has left the model of the mill since an abort was requested first may have been discarded.
void MillController::note_executed(TimePoint now) {
  Job& job = **find(running_->number);
  if (job.executed) return;
  const SendProgress progress = running_->sender.progress(now);
  job.executed = running_->prepared->executed(running_->sender.executed_for_certain(now), progress.written);
}

// A job whose abort may have been dropped may run on: it has no end that could be named.
void MillController::end_aborted(TimePoint now) {
  const bool unsure = running_->sender.abort_may_be_dropped();
  const std::string_view sent =
      unsure ? "the abort was sent, but the mill's buffer may have been full, and a full buffer drops it"
             : "the abort was sent";
  end_run(unsure ? JobEvent::abort_unsure : JobEvent::aborted, running_->aborted_by,
          fmt::format("{}; {}", sent, executed_text(**find(running_->number))), now);
}

// A mill may still execute a job that no longer runs here.
bool MillController::send_abort(TimePoint now) {
  if (link_ != MillLink::open) {
    abort_.postpone();
    return false;
  }
  abort_.write(true, now);
  return true;
}

void MillController::illegal(std::string_view machine, std::string_view state, std::string_view event) {
  if (!internal_error_.empty()) return;
  internal_error_ = fmt::format("an internal error: {} in state {} cannot have the event {}", machine, state, event);
}

// Nobody knows what the mill does: it is stopped, and a person looks at the workpiece.
void MillController::recover(TimePoint now) {
  events_.internal_error(internal_error_, now);
  if (running_) {
    Job& job = **find(running_->number);
    job.written = written_at_loss();
    running_.reset();
    permission_.end(job.number, now);
    job.state = JobState::paused_unknown;
    job.confirmation.reset();
    show_left();
    events_.job_changed(job, "", internal_error_, now);
  }
  if (send_abort(now)) link_down(now, internal_error_);
  internal_error_.clear();
}

std::string MillController::broken_invariant() const {
  for (const Job& job : jobs_) {
    if (is_end(job.state)) return fmt::format("{} has ended, and is in the queue", text_of(job));
    if ((job.state == JobState::running) != (job.number == running_job())) {
      return fmt::format("{} is {}, and job {} runs", text_of(job), name(job.state), running_job());
    }
  }
  return "";
}

}  // namespace axisgate::rml1
