// Manual operation of a simulated device.
#pragma once

#include <string>
#include <string_view>

#include "server/api/request/call.h"
#include "server/api/request/pipeline.h"
#include "server/gateway.h"

namespace axisgate::api {

// Thread safe.
class Simulators {
 public:
  // The referenced objects must outlive this one.
  Simulators(const server::Gateway& gateway, const DevicePipeline& pipeline) : gateway_(gateway), pipeline_(pipeline) {}

  // Operates the device as Simulation::operate() does. Fails with invalid_request, also if the device is not
  // simulated.
  void operate(const Call& call, std::string_view device, const std::string& command, Answer<std::string> answer) const;

 private:
  const server::Gateway& gateway_;
  const DevicePipeline& pipeline_;
};

}  // namespace axisgate::api
