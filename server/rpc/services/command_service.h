// CommandService: the controller's own commands, for functions that the other services do not cover.
#pragma once

#include "axisgate/v1/command.grpc.pb.h"
#include "server/api/stage/commands.h"

namespace axisgate::rpc {

class CommandService final : public v1::CommandService::CallbackService {
 public:
  // `commands` must outlive this object.
  explicit CommandService(const api::Commands& commands) : commands_(commands) {}

  grpc::ServerUnaryReactor* ListCommands(grpc::CallbackServerContext* context, const v1::ListCommandsRequest* request,
                                         v1::ListCommandsResponse* response) override;
  // The front answers Execute (own_answers.h).

 private:
  const api::Commands& commands_;
};

}  // namespace axisgate::rpc
