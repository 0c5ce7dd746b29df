#include "server/rpc/simulator_service.h"

#include "server/rpc/call.h"
#include "server/rpc/unary_call.h"

namespace axisgate::rpc {

grpc::ServerUnaryReactor* SimulatorService::Operate(grpc::CallbackServerContext*, const api::OperateRequest* request,
                                                    api::OperateResponse* response) {
  const auto call = UnaryCall<api::OperateResponse>::start(response);
  const Result<server::Device*> device = find_device(gateway_, request->device());
  if (!device) return call->refuse(device.error());
  (*device)->line().operate(request->command(), [call](const Result<std::string>& done) {
    if (!done) return static_cast<void>(call->refuse(done.error()));
    call->answer([&](api::OperateResponse& answer) { answer.set_answer(*done); });
  });
  return call.get();
}

}  // namespace axisgate::rpc
