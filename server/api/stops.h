// Stops: without quota, lease, queue or validate_only, and refused for nothing in their context. The only request that
// does not go through the pipeline.
#pragma once

#include <string_view>

#include "device/core/problem.h"
#include "device/stage/requests.h"
#include "server/api/admission.h"
#include "server/api/call.h"
#include "server/gateway.h"

namespace axisgate::api {

// Thread safe.
class Stops {
 public:
  // Both outlive this.
  Stops(const server::Gateway& gateway, const Admission& admission) : gateway_(gateway), admission_(admission) {}

  // Of these axes; of none named, of all. Answers when they are stationary or the wait for it has run out.
  // invalid_request, unknown_device, or as `axes` is at fault.
  void stop(const Call& call, std::string_view device, const Result<stage::AxisSet>& axes,
            Answer<stage::StopReport> answer) const;

  // Of all axes. invalid_request, unknown_device.
  void emergency_stop(const Call& call, std::string_view device, Answer<stage::StopReport> answer) const;

 private:
  const server::Gateway& gateway_;
  const Admission& admission_;
};

}  // namespace axisgate::api
