#include "device/rml1/mill/mill_controller.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "device/rml1/sending/words.h"

namespace axisgate::rml1 {
namespace {

constexpr std::string_view kExpired = "the confirmation has expired";

bool waits(const Job& job) { return job.state == JobState::queued || job.state == JobState::confirmed; }

}  // namespace

void MillController::NotedLine::write(std::string_view bytes) {
  Running& running = *mill_.running_;
  if (running.sender.state() == SenderState::sending) {
    running.noted += bytes.size();
    mill_.events_.about_to_write(running.number, running.prepared->of_body(running.noted));
  }
  line_.write(bytes);
}

MillController::MillController(const Profile& profile, const MillSettings& settings, FlowLink& line, MillEvents& events)
    : profile_(profile), settings_(settings), line_(line), noted_line_(*this, line), events_(events) {}

void MillController::add(Job job, TimePoint now) {
  job.state = JobState::queued;
  jobs_.push_back(std::move(job));
  events_.job_changed(jobs_.back(), "", now);
}

Result<Job*> MillController::find(JobNumber number) {
  const auto found = std::ranges::find(jobs_, number, &Job::number);
  if (found != jobs_.end()) return &*found;
  return fail(Reason::not_found, fmt::format("there is no job {} in the queue", number),
              "`axisctl mill queue` lists them");
}

void MillController::change(Job& job, JobEvent event, std::string_view why, TimePoint now) {
  job.state = *next(job.state, event);
  if (job.state != JobState::confirmed) job.confirmation.reset();
  events_.job_changed(job, why, now);
}

Result<void> MillController::change(JobNumber number, JobEvent event, TimePoint now) {
  const Result<Job*> job = find(number);
  if (!job) return tl::unexpected(job.error());
  if (!next((*job)->state, event)) {
    return fail(Reason::wrong_mode, fmt::format("{} is {}", text_of(**job), name((*job)->state)),
                "`axisctl mill queue` shows what can be done with it");
  }
  change(**job, event, "", now);
  leave_queue_if_ended(number);
  return {};
}

void MillController::leave_queue_if_ended(JobNumber number) {
  std::erase_if(jobs_, [number](const Job& job) { return job.number == number && is_end(job.state); });
}

Result<void> MillController::move_to_front(JobNumber number, TimePoint now) {
  const Result<Job*> job = find(number);
  if (!job) return tl::unexpected(job.error());
  if ((*job)->state != JobState::queued) {
    return fail(Reason::wrong_mode, fmt::format("{} is {}", text_of(**job), name((*job)->state)),
                "only a job that is QUEUED can be moved");
  }
  const auto first = std::ranges::find_if(jobs_, waits);
  setup_changed("another job was put before it", now);
  std::rotate(first, std::ranges::find(jobs_, number, &Job::number),
              std::ranges::find(jobs_, number, &Job::number) + 1);
  return {};
}

Result<void> MillController::check_next(const Job& job) const {
  if (running_) {
    return fail(Reason::wrong_mode, fmt::format("job {} runs", running_->number),
                "confirm the next one when it has ended");
  }
  const auto first = std::ranges::find_if(jobs_, waits);
  if (first != jobs_.end() && first->number == job.number) return {};
  if (first == jobs_.end() || !waits(job)) {
    return fail(Reason::wrong_mode, fmt::format("{} is {}", text_of(job), name(job.state)),
                "only a job that waits can be confirmed");
  }
  return fail(Reason::wrong_mode, fmt::format("{} is before {}", text_of(*first), text_of(job)),
              "confirm that one, or put this one first");
}

Result<void> MillController::confirm(JobNumber number, const JobSetup& seen, std::string by, TimePoint now) {
  const Result<Job*> job = find(number);
  if (!job) return tl::unexpected(job.error());
  if (const Result<void> is_next = check_next(**job); !is_next) return is_next;
  if (link_ != MillLink::open)
    return fail(Reason::link_down, "the line to the mill is closed", "confirm when it is open");
  if (seen != (*job)->setup) {
    return fail(
        Reason::stale_setpoint,
        fmt::format("{} needs the tool {}, the origin {} and the profile {}, or its bytes are others than those seen",
                    text_of(**job), (*job)->setup.tool, (*job)->setup.origin, (*job)->setup.profile),
        "look at the job again, then confirm what it needs");
  }
  (*job)->confirmation = Confirmation{std::move(by), now + settings_.confirmation_lasts};
  change(**job, JobEvent::confirm, "", now);
  return {};
}

Result<void> MillController::check_startable(const Job& job, const PreparedJob& prepared, TimePoint now) const {
  if (running_)
    return fail(Reason::wrong_mode, fmt::format("job {} runs", running_->number), "wait until it has ended");
  if (link_ != MillLink::open)
    return fail(Reason::link_down, "the line to the mill is closed", "start it when it is open");
  if (job.state != JobState::confirmed || job.confirmation->until <= now) {
    return fail(Reason::not_allowed, fmt::format("{} is not confirmed at the mill, or not any more", text_of(job)),
                "somebody at the mill confirms it: `axisctl mill confirm`");
  }
  if (prepared.digest() != job.setup.digest) {
    return fail(Reason::internal, fmt::format("the bytes of {} are not those that were confirmed", text_of(job)),
                "send the job again");
  }
  return {};
}

Result<void> MillController::start(JobNumber number, std::shared_ptr<const PreparedJob> prepared, TimePoint now) {
  const Result<Job*> job = find(number);
  if (!job) return tl::unexpected(job.error());
  if (const Result<void> startable = check_startable(**job, *prepared, now); !startable) return startable;
  change(**job, JobEvent::start, "", now);
  const PreparedJob& it = *prepared;
  running_.reset(new Running{number, std::move(prepared), now,
                             Sender(it.text(), it.timeline(), profile_, settings_.sending, noted_line_),
                             SenderState::ready, 0, 0, now, false, ""});
  running_->sender.start(now);
  look_at_sender(now);
  return {};
}

Result<void> MillController::pause(TimePoint now) {
  if (!running_ || running_->sender.state() != SenderState::sending) {
    return fail(Reason::wrong_mode, "no job is being sent", "`axisctl mill watch` shows what the mill does");
  }
  running_->sender.pause(now);
  look_at_sender(now);
  return {};
}

Result<void> MillController::resume(TimePoint now) {
  if (!running_ || running_->sender.state() != SenderState::paused) {
    return fail(Reason::wrong_mode, "no job is paused", "`axisctl mill watch` shows what the mill does");
  }
  running_->sender.resume(now);
  look_at_sender(now);
  return {};
}

void MillController::abort(std::string_view why, TimePoint now) {
  setup_changed(why, now);
  if (!running_) return send_abort();
  running_->aborted_why = why;
  running_->sender.abort(now);
  look_at_sender(now);
}

// Where no job runs the mill may still execute one. With a closed line it is sent when the line is back.
void MillController::send_abort() {
  must_abort_ = link_ != MillLink::open;
  if (!must_abort_) line_.write(abort_words(profile_, true));
}

Result<void> MillController::cancel(JobNumber job, TimePoint now) { return change(job, JobEvent::cancel, now); }

Result<void> MillController::done(JobNumber job, TimePoint now) { return change(job, JobEvent::done, now); }

void MillController::setup_changed(std::string_view why, TimePoint now) {
  for (Job& job : jobs_) {
    if (job.state == JobState::confirmed) change(job, JobEvent::make_void, why, now);
  }
}

std::optional<RunningJob> MillController::running(TimePoint now) {
  if (!running_) return std::nullopt;
  return view(now);
}

RunningJob MillController::view(TimePoint now) {
  SendProgress progress = running_->sender.progress(now);
  const PreparedJob& job = *running_->prepared;
  progress = {job.of_body(progress.written), progress.unsent, job.of_body(progress.executed_least),
              job.of_body(progress.executed_most)};
  return {running_->number,          running_->sender.state(), progress,
          running_->sender.run_on(), running_->started,        running_->busy};
}

void MillController::look_at_sender(TimePoint now) {
  if (!running_) return;
  look_whether_busy(now);
  const SenderState state = running_->sender.state();
  if (std::exchange(running_->seen, state) != state) events_.sender_changed(view(now), now);
  if (state == SenderState::fed) end_run(JobEvent::fed, "", now);
  if (state == SenderState::aborted)
    end_run(JobEvent::aborted, fmt::format("the abort was sent, {}", running_->aborted_why), now);
}

// A mill that is held by its panel, off, or behind a full buffer takes nothing; which of these, the line does not say.
void MillController::look_whether_busy(TimePoint now) {
  const SendProgress progress = running_->sender.progress(now);
  const std::uint64_t taken = progress.written - progress.unsent;
  const bool has_more = progress.unsent > 0 || (running_->sender.state() == SenderState::sending && line_.held());
  if (taken != running_->taken || !has_more) {
    running_->taken = taken;
    running_->taken_at = now;
  }
  const bool busy = now - running_->taken_at >= settings_.busy_limit;
  if (std::exchange(running_->busy, busy) != busy) events_.sender_changed(view(now), now);
}

void MillController::end_run(JobEvent event, std::string_view why, TimePoint now) {
  const JobNumber number = running_->number;
  Job& job = **find(number);
  if (event == JobEvent::lost) job.written = written_at_loss();
  running_.reset();
  change(job, event, why, now);
  leave_queue_if_ended(number);
}

// What had left the host may still have been in a converter, which is gone with the line.
WrittenRange MillController::written_at_loss() {
  const std::uint64_t in_converter = std::min<std::uint64_t>(settings_.sending.converter, running_->taken);
  return {running_->prepared->of_body(running_->taken - in_converter), running_->prepared->of_body(running_->noted)};
}

void MillController::inherit(Job job) {
  if (job.state == JobState::paused_unknown) must_abort_ = settings_.at_loss == AtLoss::abort;
  jobs_.push_back(std::move(job));
}

void MillController::link_up(TimePoint now) {
  now_ = now;
  link_ = MillLink::open;
  reopen_ = kReopenFirst;
  events_.link_changed(link_, "", now);
  if (must_abort_) send_abort();
}

void MillController::link_down(TimePoint now, std::string_view why) {
  now_ = now;
  link_ = MillLink::closed;
  events_.link_changed(link_, why, now);
  setup_changed("the line was lost", now);
  if (running_) {
    running_->sender.line_lost(now);
    must_abort_ = settings_.at_loss == AtLoss::abort;
    end_run(JobEvent::lost, why, now);
  }
  line_.reopen(reopen_);
  reopen_ = std::min(2 * reopen_, kReopenLast);
}

void MillController::advance(TimePoint now) {
  now_ = now;
  if (const auto until = confirmed_until(); until && *until <= now) setup_changed(kExpired, now);
  if (!running_) return;
  running_->sender.advance(now);
  look_at_sender(now);
}

std::optional<TimePoint> MillController::confirmed_until() const {
  const auto found = std::ranges::find(jobs_, JobState::confirmed, &Job::state);
  return found == jobs_.end() ? std::nullopt : std::optional(found->confirmation->until);
}

std::optional<TimePoint> MillController::next_deadline() const {
  if (!running_) return confirmed_until();
  const TimePoint look = now_ + kLook;
  return std::min(running_->sender.next_deadline(now_).value_or(look), look);
}

}  // namespace axisgate::rml1
