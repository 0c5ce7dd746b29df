// MillController: those that wait: their order, and the end of those that nobody confirms.
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>
#include <vector>

#include "device/rml1/mill/mill_controller.h"

namespace axisgate::rml1 {
namespace {

// Those that `moved` is to be before, in their order, and last itself.
std::vector<Job*> places(std::vector<Job>& jobs, const Job& moved, Overtaken overtaken) {
  std::vector<Job*> found;
  for (Job& job : jobs) {
    const bool is_overtaken = overtaken == Overtaken::all || job.owner == moved.owner;
    if (job.state == JobState::queued && is_overtaken) found.push_back(&job);
    if (&job == &moved) break;
  }
  return found;
}

}  // namespace

void MillController::inherit(Job job) {
  if (job.state == JobState::paused_unknown && settings_.at_loss == AtLoss::abort) abort_.postpone();
  const auto place = std::ranges::upper_bound(jobs_, job, is_before);
  jobs_.insert(place, std::move(job));
  show_left();
}

void MillController::inherit_left(const Job& last) {
  last_ = last;
  show_left();
}

Result<void> MillController::move_first(JobNumber number, Overtaken overtaken, std::string_view by, TimePoint now) {
  const Result<Job*> found = find(number);
  if (!found) return tl::unexpected(found.error());
  if ((*found)->state != JobState::queued) {
    return fail(Reason::wrong_mode, fmt::format("{} is {}", text_of(**found), name((*found)->state)),
                "only a job that is QUEUED can be moved");
  }
  const std::vector<Job*> cycle = places(jobs_, **found, overtaken);
  if (cycle.size() == 1) return {};
  for (std::size_t place = cycle.size() - 1; place > 0; --place) std::swap(*cycle[place], *cycle[place - 1]);
  rank_as_ordered();
  show_left();
  events_.job_changed(
      *cycle.front(), by,
      overtaken == Overtaken::all ? "moved to the front of the queue" : "moved before the other jobs of its owner",
      now);
  return {};
}

// From the last one forward, so that no rank is above 0: a job that is sent later has 0, and is behind all of them.
void MillController::rank_as_ordered() {
  for (std::size_t place = jobs_.size() - 1; place > 0; --place) {
    Job& job = jobs_[place - 1];
    const Job& next = jobs_[place];
    if (std::tie(job.rank, job.number) < std::tie(next.rank, next.number)) continue;
    job.rank = job.number < next.number ? next.rank : next.rank - 1;
    events_.rank_changed(job);
  }
}

void MillController::expire_jobs(TimePoint now) {
  const auto days = std::chrono::floor<std::chrono::days>(settings_.queued_at_most).count();
  const std::string why = fmt::format("nobody confirmed it within {} day{}", days, days == 1 ? "" : "s");
  for (Job& job : jobs_) {
    const bool is_due = job.state == JobState::queued && now - job.queued_since >= settings_.queued_at_most;
    if (is_due) change(job, JobEvent::expire, "", why, now);
  }
  std::erase_if(jobs_, [](const Job& job) { return job.state == JobState::expired; });
  show_left();
}

std::optional<TimePoint> MillController::next_expiry() const {
  std::optional<TimePoint> next;
  for (const Job& job : jobs_) {
    if (job.state != JobState::queued) continue;
    const TimePoint expiry = job.queued_since + settings_.queued_at_most;
    next = std::min(next.value_or(expiry), expiry);
  }
  return next;
}

}  // namespace axisgate::rml1
