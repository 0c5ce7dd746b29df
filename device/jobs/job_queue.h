// The jobs of a mill that have not ended, in the order of the queue. README.md has the table of their states.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/problem.h"
#include "device/core/time.h"
#include "device/core/violations.h"
#include "device/jobs/job.h"
#include "device/jobs/setup_left.h"

namespace axisgate::jobs {

// QUEUED jobs that a moved job overtakes: all, or only the jobs of its owner.
enum class Overtaken { all, of_its_owner };

// Receives the events of a queue. Called from the functions of the queue; must not call the queue.
class QueueEvents {
 public:
  virtual ~QueueEvents() = default;

  // Reports that the job was added or moved, or has changed its state. `by`: the caller who requested this; empty if no
  // caller did. `why`: reason, for people; may be empty.
  virtual void job_changed(const Job& job, std::string_view by, std::string_view why, TimePoint now) = 0;
  // Reports a new rank. The rank must be stored, so that the order of the queue survives a restart.
  virtual void rank_changed(const Job& job) = 0;
};

// Not thread safe.
class JobQueue {
 public:
  // The referenced objects must outlive this one. `queued_at_most`: time after which an unconfirmed job expires.
  JobQueue(const SetupLeft& left, Duration queued_at_most, QueueEvents& events, Violations& violations)
      : left_(left), queued_at_most_(queued_at_most), events_(events), violations_(violations) {}

  // Takes over a job of the previous run, in the order of is_before().
  void inherit(Job job);
  // Adds the job after all other jobs. Its number must be greater than theirs.
  void add(Job job, TimePoint now);

  // Returns the job. Fails with not_found.
  Result<Job*> find(JobNumber number);
  // Returns the job, which must be in the queue.
  Job& at(JobNumber number);
  // Applies an event that a caller requests. Fails with not_found, or with wrong_job_state if the job's state does not
  // allow the event.
  Result<void> request(JobNumber number, JobEvent event, std::string_view by, TimePoint now);
  // Applies an event to a job of this queue. A job that has ended leaves the queue. An event that the job's state does
  // not allow is reported as a violation and has no effect.
  void change(Job& job, JobEvent event, std::string_view by, std::string_view why, TimePoint now);
  // Makes the job PAUSED_UNKNOWN after an internal error, whatever its state is.
  void abandon(Job& job, std::string_view why, TimePoint now);
  // Moves a job before the QUEUED jobs that it overtakes: it takes the place of the first of them, the first takes the
  // place of the second, and so on. Fails with not_found, or with wrong_job_state if the job is not QUEUED.
  Result<void> move_first(JobNumber number, Overtaken overtaken, std::string_view by, TimePoint now);
  // Ends the QUEUED jobs that nobody has confirmed in time.
  void expire(TimePoint now);
  std::optional<TimePoint> next_expiry() const;

  // Sets JobSetup::left of the first waiting job if it was not begun, and clears it in all other jobs. Call this after
  // SetupLeft has changed.
  void show_left();

  const std::vector<Job>& jobs() const { return jobs_; }
  // First job in this state; null if there is none.
  const Job* first_in(JobState state) const;
  // First job that can be confirmed or is confirmed; null if there is none.
  const Job* first_waiting() const;

  // Text of the first invariant that does not hold; empty if all do.
  std::string broken_invariant() const;

 private:
  void rank_as_ordered();

  const SetupLeft& left_;
  const Duration queued_at_most_;
  QueueEvents& events_;
  Violations& violations_;
  std::vector<Job> jobs_;
};

}  // namespace axisgate::jobs
