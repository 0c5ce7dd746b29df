// Requests on jobs of a mill that wait or have been executed.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "device/jobs/job.h"
#include "server/api/mill/job_acts.h"
#include "server/api/mill/job_upload.h"
#include "server/api/request/call.h"
#include "server/gateway.h"

namespace axisgate::api {

// The cancelled jobs in the order of the queue; at least one.
struct CancelledJobs {
  const server::Mill* mill = nullptr;  // never null
  std::vector<jobs::JobNumber> jobs;
};

// Thread safe. All members also fail as JobActs::act() and jobs::Machine do.
class WaitingJobs {
 public:
  // The referenced objects must outlive this one.
  WaitingJobs(server::Gateway& gateway, const MillPipeline& pipeline, const JobActs& acts)
      : gateway_(gateway), pipeline_(pipeline), acts_(acts) {}

  // Fails with not_allowed if the caller is not at the mill's station.
  void confirm(const Call& call, std::string_view job, const jobs::JobSetup& seen, Answer<CurrentJob> answer) const;
  // Fails with not_allowed if the caller is neither the job's owner nor an administrator.
  void cancel(const Call& call, std::string_view job, Answer<CurrentJob> answer) const;
  // Cancels all jobs of `who` that wait to begin. Fails with not_found if there is none.
  void cancel_all(const Call& call, std::string_view device, std::string who, Answer<CancelledJobs> answer) const;
  // Moves a job to the front of the queue for an administrator, or before their other jobs for its owner. Fails as
  // cancel() does.
  void move_first(const Call& call, std::string_view job, Answer<CurrentJob> answer) const;
  void done(const Call& call, std::string_view job, Answer<CurrentJob> answer) const;

 private:
  server::Gateway& gateway_;
  const MillPipeline& pipeline_;
  const JobActs& acts_;
};

}  // namespace axisgate::api
