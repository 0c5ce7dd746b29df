// What a person does at a simulated device.
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
  // Both outlive this.
  Simulators(const server::Gateway& gateway, const Pipeline& pipeline) : gateway_(gateway), pipeline_(pipeline) {}

  // As stage::Simulation::operate(). invalid_request, also where the device is not simulated.
  void operate(const Call& call, std::string_view device, const std::string& command, Answer<std::string> answer) const;

 private:
  const server::Gateway& gateway_;
  const Pipeline& pipeline_;
};

}  // namespace axisgate::api
