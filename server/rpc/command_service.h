// CommandService: the controller's own commands, for what the other services do not cover.
#pragma once

#include "axisgate/v1/command.grpc.pb.h"
#include "server/access/access.h"
#include "server/gateway.h"
#include "server/rpc/stream_limit.h"

namespace axisgate::rpc {

namespace api = axisgate::v1;

class CommandService final : public api::CommandService::CallbackService {
 public:
  // All outlive this.
  CommandService(server::Gateway& gateway, const server::Access& access, StreamLimit& streams)
      : gateway_(gateway), access_(access), streams_(streams) {}

  grpc::ServerUnaryReactor* ListCommands(grpc::CallbackServerContext* context, const api::ListCommandsRequest* request,
                                         api::ListCommandsResponse* response) override;
  grpc::ServerWriteReactor<api::ExecuteResponse>* Execute(grpc::CallbackServerContext* context,
                                                          const api::ExecuteRequest* request) override;

 private:
  server::Gateway& gateway_;
  const server::Access& access_;
  StreamLimit& streams_;
};

}  // namespace axisgate::rpc
