// CommandService: the controller's own commands, for functions that the other services do not cover.
#include <vector>

#include "axisgate/v1/command.grpc.pb.h"
#include "server/api/stage/commands.h"
#include "server/proto/transactions.h"
#include "server/rpc/calls/call.h"
#include "server/rpc/calls/unary_call.h"
#include "server/rpc/services.h"

namespace axisgate::rpc {
namespace {

class CommandService final : public v1::CommandService::CallbackService {
 public:
  // `commands` must outlive this object.
  explicit CommandService(const api::Commands& commands) : commands_(commands) {}

  grpc::ServerUnaryReactor* ListCommands(grpc::CallbackServerContext* context, const v1::ListCommandsRequest* request,
                                         v1::ListCommandsResponse* response) override {
    return answer_at_once(response, commands_.list(to_call(*context), request->device()),
                          [](v1::ListCommandsResponse& answer, const std::vector<stage::CommandInfo>& commands) {
                            for (const stage::CommandInfo& info : commands)
                              *answer.add_commands() = proto::to_proto(info);
                          });
  }

  // The front answers Execute (own_answers.h).

 private:
  const api::Commands& commands_;
};

}  // namespace

std::unique_ptr<grpc::Service> command_service(const ServiceParts& parts) {
  return std::make_unique<CommandService>(parts.api.commands);
}

}  // namespace axisgate::rpc
