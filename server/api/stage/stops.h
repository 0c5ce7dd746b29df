// Stops: without quota, lease, queue or validate_only, and refused for nothing in their context. The only request that
// does not go through the pipeline.
#pragma once

#include <string_view>
#include <vector>

#include "device/core/problem.h"
#include "device/stage/requests.h"
#include "device/stage/state.h"
#include "server/api/request/admission.h"
#include "server/api/request/call.h"
#include "server/gateway.h"

namespace axisgate::api {

struct DeviceStop {
  const server::Device* device = nullptr;  // never null
  stage::StopReport report;                // of a mill without axes
  stage::State state{};                    // of a stage, as the report was made
};

// Thread safe.
class Stops {
 public:
  // Both outlive this.
  Stops(const server::Gateway& gateway, const Admission& admission) : gateway_(gateway), admission_(admission) {}

  // Of these axes; of none named, of all. Of an empty device name: of all devices, at the same time. A mill is sent the
  // abort of the job that runs; that is reported as outcome_unknown, since a mill never answers. Answers when all axes
  // are stationary, the wait for it has run out, or at the call's deadline; one for each device, in the order of the
  // configuration. Axes without a device are of the only stage; invalid_request where there are several. Also
  // unknown_device, or as `axes` is at fault.
  void stop(const Call& call, std::string_view device, const Result<stage::AxisSet>& axes,
            Answer<std::vector<DeviceStop>> answer) const;

  // The same of all axes. invalid_request, unknown_device.
  void emergency_stop(const Call& call, std::string_view device, Answer<std::vector<DeviceStop>> answer) const;

 private:
  // Those to be stopped. With `axes` only such that have some.
  Result<std::vector<server::Device*>> find_devices(std::string_view device, bool axes) const;

  const server::Gateway& gateway_;
  const Admission& admission_;
};

}  // namespace axisgate::api
