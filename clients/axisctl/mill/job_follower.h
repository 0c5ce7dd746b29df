// Shows a job of a mill while it runs, until it or one of its parts has ended.
#pragma once

#include <string>

#include "axisgate/v1/mill.pb.h"
#include "clients/axisctl/live_display.h"
#include "clients/axisctl/session.h"

namespace axisgate::axisctl {

// Starts the job of that name, which was confirmed, and with --follow shows it to its end. Returns the exit code, or
// throws Failure.
int start_job(const Session& session, const v1::CallContext& context, const std::string& job);

class JobFollower {
 public:
  // `job`: Job.name of a job that was started. Empty: the running job, or the next one that runs, if any job waits.
  JobFollower(const Session& session, const std::string& job);

  // Until the job is FED, or a part of it, or none runs or waits: kDone. Throws the Failure that another end is, and
  // when the daemon reports no more of it.
  int follow();

 private:
  // Whether the job has ended.
  bool show(const v1::Mill& mill);
  void show_progress(const v1::RunningJob& running);
  bool show_waiting(const v1::Mill& mill);
  int report_end() const;

  const Session& session_;
  const bool was_started_;  // by this run, which has said so
  LiveDisplay display_;
  v1::Job job_;             // as last seen; without a name: none has run
  v1::RunningJob running_;  // as last seen
  bool gone_ = false, nothing_to_come_ = false;
  std::string said_;  // of what waits, while none has run
};

}  // namespace axisgate::axisctl
