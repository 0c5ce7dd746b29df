// All subjects of mills, connected.
#pragma once

#include <memory>

#include "server/api/mill/job_acts.h"
#include "server/api/mill/job_pieces.h"
#include "server/api/mill/job_sending.h"
#include "server/api/mill/job_starts.h"
#include "server/api/mill/mill_operation.h"
#include "server/api/mill/mills.h"
#include "server/api/mill/waiting_jobs.h"
#include "server/api/request/fair_worker.h"
#include "server/gateway.h"

namespace axisgate::api {

class MillSubjects {
 public:
  // The referenced objects must outlive this one.
  MillSubjects(server::Gateway& gateway, const MillPipeline& pipeline, Streams& streams)
      : acts_(gateway, pipeline),
        mills(gateway, pipeline, streams),
        operation(gateway, pipeline),
        waiting(gateway, pipeline, acts_),
        starts(gateway, pipeline, acts_, worker_),
        sending(gateway, pipeline, worker_),
        pieces(gateway, pipeline, sending) {}
  ~MillSubjects() { worker_->join(); }

 private:
  // Runs the tasks that read or write a whole job, apart from the devices' strands and the threads that serve others.
  // Shared with tasks that are posted to a mill, because these may run after this object is destroyed.
  const std::shared_ptr<FairWorker> worker_ = std::make_shared<FairWorker>();
  const JobActs acts_;

 public:
  const Mills mills;
  const MillOperation operation;
  const WaitingJobs waiting;
  const JobStarts starts;
  const JobSending sending;
  const JobPieces pieces;
};

}  // namespace axisgate::api
