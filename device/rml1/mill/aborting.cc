// MillController: the abort, whether a job runs or none.
#include <fmt/format.h>

#include <string_view>

#include "device/rml1/guard.h"
#include "device/rml1/mill/mill_controller.h"
#include "device/rml1/sending/delivery.h"
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

// Where no job runs the mill may still execute one. With a closed line it is sent when the line is back.
bool MillController::send_abort(TimePoint now) {
  must_abort_ = link_ != MillLink::open;
  if (must_abort_) return false;
  noted_line_.write(abort_words(profile_, true));
  abort_since_ = now;
  return true;
}

// As Sender does it.
void MillController::look_after_abort(TimePoint now) {
  if (!abort_since_) return;
  const bool gone = line_.unsent() == 0;
  if (gone || now - *abort_since_ >= Sender::kHeldBeforeIgnored) line_.ignore_flow_control(!gone);
  if (!gone) return;
  abort_since_.reset();
  abort_has_left(now);
}

// The host. A converter may still have it.
void MillController::abort_has_left(TimePoint now) {
  abort_arrives_ = now + transmit_time(settings_.sending.converter, settings_.sending.baud);
}

bool MillController::abort_waits() const {
  return must_abort_ || abort_since_ || (running_ && running_->sender.state() == SenderState::aborting);
}

// What somebody requested, whatever is sent for a job that was lost.
bool MillController::may_have_lost_abort(TimePoint now) const {
  const bool under_way = running_ && running_->sender.state() == SenderState::aborting;
  return under_way || abort_since_ || abort_arrives_ > now;
}

}  // namespace axisgate::rml1
