// Manual operation of a mill, apart from jobs: a step, the Z origin, the spindle, raising the tool.
#pragma once

#include <string>
#include <string_view>

#include "device/core/time.h"
#include "device/jobs/hand_act.h"
#include "server/api/mill/job_acts.h"
#include "server/api/request/call.h"
#include "server/gateway.h"

namespace axisgate::api {

struct HandRequest {
  jobs::HandAct act;
  std::string origin{};  // for SetZ0: a configured origin with a height; empty: none is named
};

// Thread safe.
class MillOperation {
 public:
  // The referenced objects must outlive this one.
  MillOperation(server::Gateway& gateway, const MillPipeline& pipeline) : gateway_(gateway), pipeline_(pipeline) {}

  // `request` is the problem if the request could not be read. Answers with the longest duration by the mill's profile.
  // Fails with invalid_request if the origin does not exist or has no height, or if a height is named, too; and as
  // MillPipeline::admit() and MillController::operate() do.
  void operate(const Call& call, std::string_view device, const Result<HandRequest>& request,
               Answer<Duration> answer) const;

 private:
  server::Gateway& gateway_;
  const MillPipeline& pipeline_;
};

}  // namespace axisgate::api
