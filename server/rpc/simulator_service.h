// SimulatorService: what a person does at a simulated device.
#pragma once

#include "axisgate/v1/simulator.grpc.pb.h"
#include "server/gateway.h"

namespace axisgate::rpc {

namespace api = axisgate::v1;

class SimulatorService final : public api::SimulatorService::CallbackService {
 public:
  // Outlives this.
  explicit SimulatorService(server::Gateway& gateway) : gateway_(gateway) {}

  grpc::ServerUnaryReactor* Operate(grpc::CallbackServerContext* context, const api::OperateRequest* request,
                                    api::OperateResponse* response) override;

 private:
  server::Gateway& gateway_;
};

}  // namespace axisgate::rpc
