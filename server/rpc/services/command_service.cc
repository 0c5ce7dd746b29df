#include "server/rpc/services/command_service.h"

#include <vector>

#include "server/proto/transactions.h"
#include "server/rpc/calls/call.h"
#include "server/rpc/calls/unary_call.h"

namespace axisgate::rpc {
grpc::ServerUnaryReactor* CommandService::ListCommands(grpc::CallbackServerContext* context,
                                                       const v1::ListCommandsRequest* request,
                                                       v1::ListCommandsResponse* response) {
  return answer_at_once(response, commands_.list(to_call(*context), request->device()),
                        [](v1::ListCommandsResponse& answer, const std::vector<stage::CommandInfo>& commands) {
                          for (const stage::CommandInfo& info : commands)
                            *answer.add_commands() = proto::to_proto(info);
                        });
}

}  // namespace axisgate::rpc
