#include "device/jobs/job_queue.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>

namespace axisgate::jobs {
namespace {

// Returns the jobs that `moved` overtakes, in the order of the queue, and then `moved`.
std::vector<Job*> overtaken_by(std::vector<Job>& jobs, const Job& moved, Overtaken overtaken) {
  std::vector<Job*> found;
  for (Job& job : jobs) {
    const bool is_overtaken = overtaken == Overtaken::all || job.owner == moved.owner;
    if (job.state == JobState::queued && is_overtaken) found.push_back(&job);
    if (&job == &moved) break;
  }
  return found;
}

}  // namespace

void JobQueue::inherit(Job job) {
  const auto place = std::ranges::upper_bound(jobs_, job, is_before);
  jobs_.insert(place, std::move(job));
  show_left();
}

void JobQueue::add(Job job, TimePoint now) {
  job.state = JobState::queued;
  job.queued_since = now;
  jobs_.push_back(std::move(job));
  show_left();
  events_.job_changed(jobs_.back(), jobs_.back().owner, "", now);
}

Result<Job*> JobQueue::find(JobNumber number) {
  const auto found = std::ranges::find(jobs_, number, &Job::number);
  if (found != jobs_.end()) return &*found;
  return fail(Reason::not_found, fmt::format("there is no job {} in the queue", number), "`GetMill` lists them");
}

Job& JobQueue::at(JobNumber number) { return **find(number); }

const Job* JobQueue::first_in(JobState state) const {
  const auto found = std::ranges::find(jobs_, state, &Job::state);
  return found == jobs_.end() ? nullptr : &*found;
}

const Job* JobQueue::first_waiting() const {
  const auto found = std::ranges::find_if(jobs_, is_waiting);
  return found == jobs_.end() ? nullptr : &*found;
}

Result<void> JobQueue::request(JobNumber number, JobEvent event, std::string_view by, TimePoint now) {
  const Result<Job*> job = find(number);
  if (!job) return tl::unexpected(job.error());
  if (!next((*job)->state, event)) {
    return fail(Reason::wrong_job_state, fmt::format("{} is {}", text_of(**job), name((*job)->state)),
                "`GetMill` shows what can be done with it");
  }
  change(**job, event, by, "", now);
  return {};
}

void JobQueue::change(Job& job, JobEvent event, std::string_view by, std::string_view why, TimePoint now) {
  const auto to = next(job.state, event);
  if (!to) return violations_.illegal("job", name(job.state), name(event));
  job.state = *to;
  if (job.state != JobState::confirmed) job.confirmation.reset();
  if (job.state == JobState::queued) job.queued_since = now;
  show_left();
  events_.job_changed(job, by, why, now);
  std::erase_if(jobs_, [](const Job& one) { return is_end(one.state); });
}

void JobQueue::abandon(Job& job, std::string_view why, TimePoint now) {
  job.state = JobState::paused_unknown;
  job.confirmation.reset();
  show_left();
  events_.job_changed(job, "", why, now);
}

// A job that was begun shows no settings: the person who confirms it confirms the tool and Z0 in any case.
void JobQueue::show_left() {
  for (Job& job : jobs_) job.setup.left.clear();
  const auto first = std::ranges::find_if(jobs_, is_waiting);
  if (first != jobs_.end() && waits_to_begin(*first)) first->setup.left = left_.texts();
}

Result<void> JobQueue::move_first(JobNumber number, Overtaken overtaken, std::string_view by, TimePoint now) {
  const Result<Job*> found = find(number);
  if (!found) return tl::unexpected(found.error());
  if ((*found)->state != JobState::queued) {
    return fail(Reason::wrong_job_state, fmt::format("{} is {}", text_of(**found), name((*found)->state)),
                "only a job that is QUEUED can be moved");
  }
  const std::vector<Job*> cycle = overtaken_by(jobs_, **found, overtaken);
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

// Sets the ranks from the last job to the first, so that no rank is above 0: a job that is sent later has the rank 0,
// and comes after all these jobs.
void JobQueue::rank_as_ordered() {
  for (std::size_t place = jobs_.size() - 1; place > 0; --place) {
    Job& job = jobs_[place - 1];
    const Job& next = jobs_[place];
    if (std::tie(job.rank, job.number) < std::tie(next.rank, next.number)) continue;
    job.rank = job.number < next.number ? next.rank : next.rank - 1;
    events_.rank_changed(job);
  }
}

void JobQueue::expire(TimePoint now) {
  const auto days = std::chrono::floor<std::chrono::days>(queued_at_most_).count();
  const std::string why = fmt::format("nobody confirmed it within {} day{}", days, days == 1 ? "" : "s");
  const auto is_due = [&](const Job& job) {
    return job.state == JobState::queued && now - job.queued_since >= queued_at_most_;
  };
  for (auto due = std::ranges::find_if(jobs_, is_due); due != jobs_.end(); due = std::ranges::find_if(jobs_, is_due)) {
    change(*due, JobEvent::expire, "", why, now);
  }
}

std::optional<TimePoint> JobQueue::next_expiry() const {
  std::optional<TimePoint> next;
  for (const Job& job : jobs_) {
    if (job.state != JobState::queued) continue;
    const TimePoint expiry = job.queued_since + queued_at_most_;
    next = std::min(next.value_or(expiry), expiry);
  }
  return next;
}

std::string JobQueue::broken_invariant() const {
  for (const Job& job : jobs_) {
    if (is_end(job.state)) return fmt::format("{} has ended, and is in the queue", text_of(job));
    if (job.confirmation.has_value() != (job.state == JobState::confirmed)) {
      return fmt::format("{} is {} and has {} confirmation", text_of(job), name(job.state),
                         job.confirmation ? "a" : "no");
    }
  }
  if (std::ranges::count(jobs_, JobState::confirmed, &Job::state) > 1) return "two jobs are confirmed";
  if (std::ranges::count(jobs_, JobState::running, &Job::state) > 1) return "two jobs run";
  if (!std::ranges::is_sorted(jobs_, is_before)) return "the jobs are not in the order of is_before()";
  return "";
}

}  // namespace axisgate::jobs
