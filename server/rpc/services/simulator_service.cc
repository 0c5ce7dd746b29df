#include "server/rpc/services/simulator_service.h"

#include "server/rpc/calls/call.h"
#include "server/rpc/calls/unary_call.h"

namespace axisgate::rpc {

grpc::ServerUnaryReactor* SimulatorService::Operate(grpc::CallbackServerContext* context,
                                                    const v1::OperateRequest* request, v1::OperateResponse* response) {
  const auto call = UnaryCall<v1::OperateResponse>::start(response);
  simulators_.operate(to_call(*context), request->device(), request->command(),
                      answering<std::string>(
                          call, [](v1::OperateResponse& answer, const std::string& text) { answer.set_answer(text); }));
  return call.get();
}

}  // namespace axisgate::rpc
