// Jobs that come from a caller, and ended jobs that are queued once more.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "device/core/problem.h"
#include "device/rml1/mill/job.h"
#include "server/api/mill/job_starts.h"
#include "server/api/mill/job_upload.h"
#include "server/api/request/call.h"
#include "server/api/request/fair_worker.h"
#include "server/gateway.h"

namespace axisgate::api {

// A JobToRepeat says how a job that has ended is queued once more.
struct JobToRepeat {
  bool rest = false;                           // from a line of it on
  LineToChoose from;                           // of the rest
  std::vector<std::string> accepted_warnings;  // beside those that were accepted for it
};

// Thread safe. Both members also fail as MillPipeline::admit() does.
class JobSending {
 public:
  // The referenced objects must outlive this one. `worker` is shared with what is posted to a mill.
  JobSending(server::Gateway& gateway, const MillPipeline& pipeline, std::shared_ptr<FairWorker> worker)
      : gateway_(gateway), pipeline_(pipeline), worker_(std::move(worker)) {}

  // Fails with invalid_request if there is no such tool, origin or profile, or no warning of a name, if there are too
  // many parts, or if the line cannot stream so; as check_same_workpiece() does; queue_full.
  Result<std::unique_ptr<JobUpload>> send(const Call& call, std::string_view device, JobToSend job) const;
  // Fails as server::ended_job(), server::chosen_rest() and JobUpload::finish() do, and with wrong_mode if it has no
  // rest.
  void repeat(const Call& call, std::string_view job, JobToRepeat how, Answer<CurrentJob> answer) const;

 private:
  Result<std::unique_ptr<JobUpload>> begin_upload(RequestKind kind, const Call& call,
                                                  const MillPipeline::Admitted& admitted, JobToSend job,
                                                  JobsBefore before) const;
  Result<std::shared_ptr<JobUpload>> begin_repeat(const Call& call, const MillPipeline::Admitted& admitted,
                                                  rml1::JobNumber number, const JobToRepeat& how) const;

  server::Gateway& gateway_;
  const MillPipeline& pipeline_;
  const std::shared_ptr<FairWorker> worker_;
};

}  // namespace axisgate::api
