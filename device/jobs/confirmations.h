// Confirmations: before a job begins, a person at the mill says that the material and the tool are in, that the origin
// is set, and that no obstacle is in the machine. README.md says for how long a confirmation is valid.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "device/core/problem.h"
#include "device/core/time.h"
#include "device/jobs/job.h"
#include "device/jobs/job_queue.h"
#include "device/jobs/setup_left.h"

namespace axisgate::jobs {

// Not thread safe.
class Confirmations {
 public:
  // The referenced objects must outlive this one. `lasts`: time for which a confirmation is valid.
  Confirmations(JobQueue& queue, const SetupLeft& left, Duration lasts) : queue_(queue), left_(left), lasts_(lasts) {}

  // Checks that the job is the next to be confirmed. Fails with not_found. Fails with wrong_job_state if the job does
  // not wait, if another job comes first, or if a job is FED or PAUSED_UNKNOWN. Call it only while no job runs.
  Result<void> check_next(JobNumber number) const;
  // Confirms a job for which check_next() has passed. Fails with setup_changed if `seen` differs from the job's setup,
  // or if Z0 was sent to the mill since the workpiece that the job continues was begun.
  Result<void> confirm(JobNumber number, const JobSetup& seen, std::string by, TimePoint now);
  // Fails with not_confirmed if the job is not confirmed, or no longer confirmed.
  Result<void> check(const Job& job, TimePoint now) const;
  // Voids the confirmation, if there is one. `why`: reason, for people.
  void make_void(std::string_view why, TimePoint now);
  // Voids a confirmation that has expired.
  void advance(TimePoint now);
  // Time at which the confirmation expires; nullopt if no job is confirmed.
  std::optional<TimePoint> until() const;

 private:
  Result<void> check_settled() const;
  Result<void> check_z0(const Job& job) const;

  JobQueue& queue_;
  const SetupLeft& left_;
  const Duration lasts_;
};

}  // namespace axisgate::jobs
