// Stops. They need no quota, lease, queue or validate_only, and their context never refuses them. No other request
// bypasses the pipeline.
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
  stage::StopReport report;                // without axes for a mill
  stage::State state{};                    // of a stage, at the time of the report
};

// Thread safe.
class Stops {
 public:
  // The referenced objects must outlive this one.
  Stops(const server::Gateway& gateway, const Admission& admission) : gateway_(gateway), admission_(admission) {}

  // Stops `axes`; empty: all. Empty device name: stops all devices at the same time. A mill receives the abort of its
  // running job, reported as outcome_unknown, because a mill never answers. Answers when all axes are stationary, when
  // the wait for this has run out, or at the call's deadline, with one report for each device, in the order of the
  // configuration. Axes without a device belong to the only stage; fails with invalid_request if there are several.
  // Also fails with unknown_device, and with the problem of `axes`.
  void stop(const Call& call, std::string_view device, const Result<stage::AxisSet>& axes,
            Answer<std::vector<DeviceStop>> answer) const;

  // Does the same with an emergency stop of all axes. Fails with invalid_request or unknown_device.
  void emergency_stop(const Call& call, std::string_view device, Answer<std::vector<DeviceStop>> answer) const;

 private:
  // Returns the devices to stop. With `axes` and an empty name, returns only stages.
  Result<std::vector<server::Device*>> find_devices(std::string_view device, bool axes) const;

  const server::Gateway& gateway_;
  const Admission& admission_;
};

}  // namespace axisgate::api
