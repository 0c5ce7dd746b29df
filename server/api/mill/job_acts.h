// Requests that act on one job of a mill, on the strand of its device, once for each request id.
#pragma once

#include <functional>
#include <string_view>

#include "device/core/problem.h"
#include "device/jobs/machine.h"
#include "server/api/mill/job_upload.h"
#include "server/api/request/call.h"
#include "server/api/request/pipeline.h"
#include "server/devices/mill.h"
#include "server/gateway.h"

namespace axisgate::api {

// Fails with deadline_passed if the request's time ran out while it was posted or waited for the journal.
Result<void> check_in_time(const TurnOf<server::Mill>& turn);

// Returns the job from the mill's queue. Fails with not_found.
Result<jobs::Job> find_job(const jobs::Machine& mill, jobs::JobNumber number);

// Thread safe.
class JobActs {
 public:
  // The referenced objects must outlive this one.
  JobActs(server::Gateway& gateway, const MillPipeline& pipeline) : gateway_(gateway), pipeline_(pipeline) {}

  using Act = std::function<Result<void>(jobs::Machine&, const jobs::Job&, const TurnOf<server::Mill>&)>;
  // Acts on the named job. Answers with the job's new state, once the spool has stored it. A repeated request does not
  // act again. Fails as MillPipeline::admit() and `act` do, and with not_found or deadline_passed.
  void act(RequestKind kind, const Call& call, std::string_view job, Act act, Answer<CurrentJob> answer) const;

 private:
  server::Gateway& gateway_;
  const MillPipeline& pipeline_;
};

}  // namespace axisgate::api
