// What a person does with a mill besides jobs: a step, the Z origin, the spindle, the tool up.
#pragma once

#include <string>
#include <string_view>

#include "device/core/time.h"
#include "device/rml1/mill/by_hand.h"
#include "server/api/mill/job_acts.h"
#include "server/api/request/call.h"
#include "server/gateway.h"

namespace axisgate::api {

struct HandRequest {
  rml1::HandAct act;
  std::string origin{};  // of SetSurface: a configured origin with a height; empty: none is named
};

// Thread safe.
class MillOperation {
 public:
  // Both outlive this.
  MillOperation(server::Gateway& gateway, const MillPipeline& pipeline) : gateway_(gateway), pipeline_(pipeline) {}

  // `request`: or why it cannot be read. The answer: how long it takes at most, by the mill's profile. invalid_request,
  // where there is no such origin, it has no height, or a height is named, too; those of MillPipeline::admit() and of
  // MillController::operate().
  void operate(const Call& call, std::string_view device, const Result<HandRequest>& request,
               Answer<Duration> answer) const;

 private:
  server::Gateway& gateway_;
  const MillPipeline& pipeline_;
};

}  // namespace axisgate::api
