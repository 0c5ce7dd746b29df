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

// QUEUED jobs that a moved job overtakes.
enum class Overtaken { all, of_its_owner };

// Listens to a queue. Called from within its members; must not call back.
class QueueEvents {
 public:
  virtual ~QueueEvents() = default;

  // The job was added, has another state, or was moved. `by`: who requested that; empty: nobody. `why`: for people; may
  // be empty.
  virtual void job_changed(const Job& job, std::string_view by, std::string_view why, TimePoint now) = 0;
  // The rank must be kept: by it the order of the queue outlives a restart.
  virtual void rank_changed(const Job& job) = 0;
};

// Not thread safe.
class JobQueue {
 public:
  // The referenced objects must outlive this one. `queued_at_most`: time after which a job that nobody has confirmed
  // ends.
  JobQueue(const SetupLeft& left, Duration queued_at_most, QueueEvents& events, Violations& violations)
      : left_(left), queued_at_most_(queued_at_most), events_(events), violations_(violations) {}

  // Takes over a job of the run before, at the place that is_before() gives it.
  void inherit(Job job);
  // Puts the job after all others. The numbers ascend.
  void add(Job job, TimePoint now);

  // Fails with not_found.
  Result<Job*> find(JobNumber number);
  // The job, which is in the queue.
  Job& at(JobNumber number);
  // Fails with not_found, or with wrong_mode if the job's state does not have the event.
  Result<void> request(JobNumber number, JobEvent event, std::string_view by, TimePoint now);
  // Changes the state of a job of this queue; a job that has ended leaves the queue. An event that the state does not
  // have is reported, and changes nothing.
  void change(Job& job, JobEvent event, std::string_view by, std::string_view why, TimePoint now);
  // After an internal error: the job is PAUSED_UNKNOWN, whatever its state was.
  void abandon(Job& job, std::string_view why, TimePoint now);
  // The job takes the place of the first QUEUED one of those that it may be before; each of these takes that of the
  // next one. Fails with not_found, or with wrong_mode if it is not QUEUED.
  Result<void> move_first(JobNumber number, Overtaken overtaken, std::string_view by, TimePoint now);
  // Ends the jobs that nobody has confirmed in time.
  void expire(TimePoint now);
  std::optional<TimePoint> next_expiry() const;

  // Shows what was left to the first job that waits to begin. Call it when SetupLeft has changed.
  void show_left();

  const std::vector<Job>& jobs() const { return jobs_; }
  const Job* first_in(JobState state) const;  // null if there is none
  // The first job that can be confirmed, or is; null if there is none.
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
