// The job that runs.
#pragma once

#include "device/core/time.h"
#include "device/jobs/job.h"
#include "device/jobs/run_on.h"
#include "device/jobs/sending.h"
#include "device/jobs/time_range.h"

namespace axisgate::jobs {

// State of the job that runs, for others.
struct RunningJob {
  JobNumber number = 0;
  SenderState sender = SenderState::ready;
  SendProgress progress;  // in bytes of the job itself
  RunOn run_on;
  TimeRange left;  // of the job, as takes() counts
  TimePoint started{};
  bool busy = false;  // the mill has taken nothing for MachineSettings::busy_limit
};

// Listens to the job that runs. Called from within its members; must not call back.
class RunEvents {
 public:
  virtual ~RunEvents() = default;

  virtual void sender_changed(const RunningJob& running, TimePoint now) = 0;
  // Bytes of the job up to sent.most go to the line next, and the mill has those up to sent.least. What must outlive a
  // killed daemon is kept before it returns.
  virtual void about_to_write(JobNumber job, const WrittenRange& sent) = 0;
};

}  // namespace axisgate::jobs
