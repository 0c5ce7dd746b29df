// SimulatorService: actions of a person at a simulated device.
#include "axisgate/v1/simulator.grpc.pb.h"
#include "server/api/looking/simulators.h"
#include "server/rpc/calls/call.h"
#include "server/rpc/calls/unary_call.h"
#include "server/rpc/services.h"

namespace axisgate::rpc {
namespace {

class SimulatorService final : public v1::SimulatorService::CallbackService {
 public:
  // `simulators` must outlive this object.
  explicit SimulatorService(const api::Simulators& simulators) : simulators_(simulators) {}

  grpc::ServerUnaryReactor* Operate(grpc::CallbackServerContext* context, const v1::OperateRequest* request,
                                    v1::OperateResponse* response) override {
    const auto call = UnaryCall<v1::OperateResponse>::start(response);
    simulators_.operate(to_call(*context), request->device(), request->command(),
                        answering<std::string>(call, [](v1::OperateResponse& answer, const std::string& text) {
                          answer.set_answer(text);
                        }));
    return call.get();
  }

 private:
  const api::Simulators& simulators_;
};

}  // namespace

std::unique_ptr<grpc::Service> simulator_service(const ServiceParts& parts) {
  return std::make_unique<SimulatorService>(parts.api.simulators);
}

}  // namespace axisgate::rpc
