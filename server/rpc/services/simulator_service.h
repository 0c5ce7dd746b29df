// SimulatorService: actions of a person at a simulated device.
#pragma once

#include "axisgate/v1/simulator.grpc.pb.h"
#include "server/api/looking/simulators.h"

namespace axisgate::rpc {

class SimulatorService final : public v1::SimulatorService::CallbackService {
 public:
  // `simulators` must outlive this object.
  explicit SimulatorService(const api::Simulators& simulators) : simulators_(simulators) {}

  grpc::ServerUnaryReactor* Operate(grpc::CallbackServerContext* context, const v1::OperateRequest* request,
                                    v1::OperateResponse* response) override;

 private:
  const api::Simulators& simulators_;
};

}  // namespace axisgate::rpc
