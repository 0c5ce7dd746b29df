// MillController: a job that is paused, and continued.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <string_view>

#include "device/rml1/mill/mill_controller.h"
#include "device/rml1/sending/words.h"

namespace axisgate::rml1 {
namespace {

// From the top above anywhere back to where a tool was raised: across, down, and until the spindle turns.
Duration longest_return(const Profile& profile, double slack) {
  const Duration across = longest_way(std::hypot(profile.x_mm, profile.y_mm), profile.speed.travel, profile, slack);
  const Duration down = longest_way(profile.z_mm, profile.speed.z_minimum, profile, slack);
  return across + down + std::chrono::duration_cast<Duration>(std::chrono::duration<double>(profile.spindle.spin_up_s));
}

}  // namespace

// A job that was raised no longer runs: it is PAUSED in the queue.
Result<void> MillController::check_sending(bool raise) const {
  const auto already = [](JobNumber job, std::string_view is, std::string_view hint) {
    return fail(Reason::wrong_mode, fmt::format("job {} is {} already", job, is), std::string(hint));
  };
  switch (running_ ? running_->sender.state() : SenderState::ready) {
    case SenderState::sending:
    case SenderState::finishing:
      return {};
    case SenderState::paused:
      if (raise) return {};
      return already(running_->number, "paused",
                     "`axisctl mill resume` continues it; `axisctl mill pause --raise` raises its tool");
    case SenderState::raising:
      return already(running_->number, "being paused", "its tool goes up after what was sent");
    default:
      break;
  }
  const auto paused = std::ranges::find(jobs_, JobState::paused, &Job::state);
  if (!running_ && paused != jobs_.end()) {
    return already(paused->number, "paused", "it continues once it is confirmed and started");
  }
  return fail(Reason::wrong_mode, "no job is being sent", "`axisctl mill watch` shows what the mill does");
}

Result<void> MillController::check_pausable(bool raise, TimePoint now) {
  if (const Result<void> sending = check_sending(raise); !sending) return sending;
  const std::uint64_t written = running_->prepared->of_body(running_->sender.progress(now).written);
  const bool has_rest = written < part_end(**find(running_->number));
  if (running_->sender.state() != SenderState::finishing && (has_rest || !raise)) return {};
  const bool last = is_last_part(**find(running_->number));
  return fail(
      Reason::wrong_mode, fmt::format("the last byte of the {} has just been written", last ? "job" : "part that runs"),
      last ? "`axisctl mill abort` ends it" : "its tool goes up by itself, and the job then waits for the next");
}

Result<void> MillController::pause(bool raise, TimePoint now) {
  if (running_) running_->sender.advance(now);
  const Result<void> can = check_pausable(raise, now);
  if (can) raise ? running_->sender.raise(now) : running_->sender.pause(now);
  look_at_sender(now);
  return can;
}

Result<void> MillController::resume(const stage::RequestContext& by, TimePoint now) {
  if (!running_ || running_->sender.state() != SenderState::paused) {
    return fail(
        Reason::wrong_mode, "no job is paused with the tool in the cut",
        "`axisctl mill queue` shows what the mill does; one that is PAUSED continues when it is confirmed and started");
  }
  if (const Result<void> may = authorize(by, 0, now); !may) return may;
  running_->sender.resume(now);
  look_at_sender(now);
  return {};
}

Result<void> MillController::choose_rest(JobNumber number, const JobRest& rest, std::string_view by, TimePoint now) {
  const Result<Job*> job = find(number);
  if (!job) return tl::unexpected(job.error());
  if (!next((*job)->state, JobEvent::choose_rest)) {
    return fail(Reason::wrong_mode, fmt::format("{} is {}", text_of(**job), name((*job)->state)),
                "only a job that is PAUSED_UNKNOWN or PAUSED is continued from a line");
  }
  (*job)->setup.from = rest.from;
  set_plan(**job, rest.takes, rest.run_on);
  change(**job, JobEvent::choose_rest, by,
         fmt::format("it continues at line {}, column {}", rest.from.line, rest.from.column), now);
  return {};
}

void MillController::plan_rest(const Job& planned) {
  const Result<Job*> job = find(planned.number);
  const bool same = job && (*job)->state == JobState::paused && (*job)->setup.from == planned.setup.from &&
                    (*job)->part == planned.part && planned.part < planned.parts.size() &&
                    planned.parts.size() == (*job)->parts.size();
  if (same) (*job)->parts[planned.part] = planned.parts[planned.part];
}

// Its rest is confirmed as a job is: the tool is elsewhere, and somebody may have reached into the machine.
void MillController::end_raised(TimePoint now) {
  const std::uint64_t written = running_->sender.progress(now).written;
  const Place from = running_->prepared->place(written);
  Job& job = **find(running_->number);
  job.setup.from = from;
  TimeRange left = running_->prepared->times().left(written, written);
  left.most += longest_return(profile_, running_->prepared->plan().slack);
  set_plan(job, left, running_->sender.run_on());
  job.written = WrittenRange{running_->prepared->of_body(written), running_->prepared->of_body(written)};
  end_run(JobEvent::raised, "",
          fmt::format("the tool is up; it continues at line {}, column {}", from.line, from.column), now);
}

}  // namespace axisgate::rml1
