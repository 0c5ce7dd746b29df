#include "device/jobs/confirmations.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "device/jobs/guard.h"

namespace axisgate::jobs {
namespace {

constexpr std::string_view kExpired = "the confirmation has expired";

Result<void> check_same_left(const Job& job, const JobSetup& seen) {
  if (seen.left == job.setup.left) return {};
  return fail(
      Reason::setup_changed,
      fmt::format("before {}: {}; that is not what was seen", text_of(job),
                  job.setup.left.empty() ? "nothing is left" : fmt::format("{}", fmt::join(job.setup.left, ", "))),
      "look at the job again, then confirm it");
}

Result<void> check_same_setup(const Job& job, const JobSetup& seen) {
  if (seen == job.setup) return {};
  return fail(
      Reason::setup_changed,
      fmt::format("{} needs the tool {}, the origin {} and the profile {}, or its bytes are others than those seen",
                  text_of(job), job.setup.tool, job.setup.origin, job.setup.profile),
      "look at the job again, then confirm what it needs");
}

}  // namespace

// Fails if a job is FED or PAUSED_UNKNOWN, because its workpiece may still be in the mill.
Result<void> Confirmations::check_settled() const {
  if (!guarded(MillGuard::settled_before_next)) return {};
  const auto& jobs = queue_.jobs();
  const auto open = std::ranges::find_if(
      jobs, [](const Job& job) { return job.state == JobState::fed || job.state == JobState::paused_unknown; });
  if (open == jobs.end()) return {};
  const bool fed = open->state == JobState::fed;
  return fail(Reason::wrong_job_state, fmt::format("{} is {}", text_of(*open), name(open->state)),
              fed ? "look at its workpiece, then report it as done: `ReportJobDone`"
                  : "look at the mill, then take the job out of the queue: `CancelJob`");
}

Result<void> Confirmations::check_next(JobNumber number) const {
  const Result<Job*> found = queue_.find(number);
  if (!found) return tl::unexpected(found.error());
  const Job& job = **found;
  if (const Result<void> settled = check_settled(); !settled) return settled;
  const Job* const first = queue_.first_waiting();
  if (first == &job) return {};
  if (first == nullptr || !is_waiting(job)) {
    return fail(Reason::wrong_job_state, fmt::format("{} is {}", text_of(job), name(job.state)),
                "only a job that waits can be confirmed");
  }
  const auto unfinished = [&](const std::string& how_it_continues) {
    return fail(Reason::wrong_job_state, fmt::format("{} is not finished: {}", text_of(*first), how_it_continues),
                "confirm that one, or have it cancelled");
  };
  if (first->setup.from && !waits_to_begin(*first)) {
    return unfinished(fmt::format("it continues at line {}", first->setup.from->line));
  }
  if (first->part > 0 && !waits_to_begin(*first)) {
    return unfinished(fmt::format("its next tool is {}", first->setup.tool));
  }
  return fail(Reason::wrong_job_state, fmt::format("{} is before {}", text_of(*first), text_of(job)),
              "confirm that one, or have it cancelled; `MoveJob` moves a job forward");
}

// A job that continues the workpiece of another job was checked with the heights of that job, so Z0 must be the same.
Result<void> Confirmations::check_z0(const Job& job) const {
  const bool as_checked = job.z0_count == left_.z0_count();
  if (job.continues == 0 || job.setup.from || !waits_to_begin(job) || as_checked) return {};
  return fail(Reason::setup_changed,
              fmt::format("Z0 was sent to the mill since job {} began, and {} was checked on its workpiece",
                          job.continues, text_of(job)),
              "cancel the job, and send it without the one that it continues");
}

Result<void> Confirmations::confirm(JobNumber number, const JobSetup& seen, std::string by, TimePoint now) {
  Job& job = queue_.at(number);
  const Result<void> checked = check_z0(job).and_then([&] { return check_same_left(job, seen); }).and_then([&] {
    return check_same_setup(job, seen);
  });
  if (!checked) return checked;
  job.confirmation = Confirmation{by, now + lasts_};
  job.void_because.clear();
  queue_.change(job, JobEvent::confirm, by, "", now);
  return {};
}

Result<void> Confirmations::check(const Job& job, TimePoint now) const {
  if (job.state == JobState::confirmed && job.confirmation->until > now) return {};
  return fail(Reason::not_confirmed,
              job.void_because.empty()
                  ? fmt::format("{} is not confirmed at the mill", text_of(job))
                  : fmt::format("{} is no longer confirmed at the mill, since {}", text_of(job), job.void_because),
              "somebody at the mill confirms it: `ConfirmJob`");
}

void Confirmations::make_void(std::string_view why, TimePoint now) {
  const Job* const confirmed = queue_.first_in(JobState::confirmed);
  if (confirmed == nullptr) return;
  Job& job = queue_.at(confirmed->number);
  job.void_because = why;
  queue_.change(job, void_event(job), "", why, now);
}

void Confirmations::advance(TimePoint now) {
  if (const auto expires = until(); expires && *expires <= now) make_void(kExpired, now);
}

std::optional<TimePoint> Confirmations::until() const {
  const Job* const confirmed = queue_.first_in(JobState::confirmed);
  return confirmed == nullptr ? std::nullopt : std::optional(confirmed->confirmation->until);
}

}  // namespace axisgate::jobs
