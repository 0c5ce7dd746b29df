// The running job.
#pragma once

#include "device/core/time.h"
#include "device/jobs/job.h"
#include "device/jobs/run_on.h"
#include "device/jobs/sending.h"
#include "device/jobs/time_range.h"

namespace axisgate::jobs {

// State of the running job, as shown outside of the machine.
struct RunningJob {
  JobNumber number = 0;
  SenderState sender = SenderState::ready;
  SendProgress progress;  // in bytes of the job, without prologue and epilogue
  RunOn run_on;
  TimeRange left;  // remaining time of the job, without tool changes, as in takes()
  TimePoint started{};
  bool busy = false;  // the mill has taken no byte for MachineSettings::busy_limit
};

// Receives the events of the running job. Called from the functions of the machine; must not call the machine.
class RunEvents {
 public:
  virtual ~RunEvents() = default;

  virtual void sender_changed(const RunningJob& running, TimePoint now) = 0;
  // Reports that the bytes of the job up to `sent.most` are written to the line next, and that the mill has received
  // the bytes up to `sent.least`. Data that must survive a killed daemon must be stored before this function returns.
  virtual void about_to_write(JobNumber job, const WrittenRange& sent) = 0;
};

}  // namespace axisgate::jobs
