// Jobs that a caller uploads, and ended jobs that are queued again.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "device/core/problem.h"
#include "device/jobs/job.h"
#include "server/api/mill/job_starts.h"
#include "server/api/mill/job_upload.h"
#include "server/api/request/call.h"
#include "server/api/request/fair_worker.h"
#include "server/gateway.h"

namespace axisgate::api {

// A JobToRepeat says how an ended job is queued again.
struct JobToRepeat {
  bool rest = false;                           // queue only the rest, from a line on
  LineToChoose from;                           // start of the rest
  std::vector<std::string> accepted_warnings;  // in addition to the warnings accepted for the ended job
};

// Thread safe. Both members also fail as MillPipeline::admit() does.
class JobSending {
 public:
  // The referenced objects must outlive this one. `worker` is shared with tasks that are posted to a mill.
  JobSending(server::Gateway& gateway, const MillPipeline& pipeline, std::shared_ptr<FairWorker> worker)
      : gateway_(gateway), pipeline_(pipeline), worker_(std::move(worker)) {}

  // Starts an upload. Fails with invalid_request if a tool, origin, profile or warning does not exist, if there are too
  // many parts, or if the line does not support the streaming; as check_same_workpiece() does; and with queue_full.
  Result<std::unique_ptr<JobUpload>> send(const Call& call, std::string_view device, JobToSend job) const;
  // Queues an ended job again. Fails as server::ended_job(), server::chosen_rest() and JobUpload::finish() do, and with
  // wrong_job_state if the rest is requested and there is none.
  void repeat(const Call& call, std::string_view job, JobToRepeat how, Answer<CurrentJob> answer) const;

 private:
  Result<std::unique_ptr<JobUpload>> begin_upload(RequestKind kind, const Call& call,
                                                  const MillPipeline::Admitted& admitted, JobToSend job,
                                                  JobsBefore before) const;
  Result<std::shared_ptr<JobUpload>> begin_repeat(const Call& call, const MillPipeline::Admitted& admitted,
                                                  jobs::JobNumber number, const JobToRepeat& how) const;

  server::Gateway& gateway_;
  const MillPipeline& pipeline_;
  const std::shared_ptr<FairWorker> worker_;
};

}  // namespace axisgate::api
