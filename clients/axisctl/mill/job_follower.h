// Display of a mill's job while it runs, until the job or one of its parts has ended.
#pragma once

#include <string>

#include "axisgate/v1/mill.pb.h"
#include "clients/axisctl/live_display.h"
#include "clients/axisctl/session.h"

namespace axisgate::axisctl {

// Starts a confirmed job by its name, and with --follow shows it until it has ended. Returns the exit code, or throws
// Failure.
int start_job(const Session& session, const v1::CallContext& context, const std::string& job);

class JobFollower {
 public:
  // `job` is the Job.name of a started job. Empty: the running job, or else the next job that runs, if any job waits.
  JobFollower(const Session& session, const std::string& job);

  // Shows the job until it halts or ends. Returns kDone if the job or one of its parts was sent whole, if the job is
  // PAUSED or DONE, or if no job runs or waits. Throws Failure if the job ended otherwise, or if the daemon stops
  // reporting the job.
  int follow();

 private:
  // Reports whether the job has halted or ended.
  bool show(const v1::Mill& mill);
  void show_progress(const v1::RunningJob& running);
  bool show_waiting(const v1::Mill& mill);
  int report_end() const;

  const Session& session_;
  const bool was_started_;  // by this run of axisctl, which has printed it
  LiveDisplay display_;
  v1::Job job_;             // newest state; without a name if no job has run yet
  v1::RunningJob running_;  // newest state
  bool gone_ = false, nothing_to_come_ = false;
  std::string said_;  // last text about a waiting job, before a job runs
};

}  // namespace axisgate::axisctl
