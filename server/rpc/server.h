// The gRPC server with all services, on a loopback address and a Unix socket.
#pragma once

#include <grpcpp/server.h>

#include <memory>
#include <string>

#include "device/core/problem.h"
#include "server/config.h"
#include "server/gateway.h"
#include "server/rpc/command_service.h"
#include "server/rpc/device_service.h"
#include "server/rpc/event_service.h"
#include "server/rpc/health_service.h"
#include "server/rpc/stage_service.h"
#include "server/rpc/stream_limit.h"

namespace axisgate::rpc {

class Server {
 public:
  // Serves at once. Refuses an address that somebody else serves, and a socket whose directory cannot be trusted.
  // `gateway` outlives the server.
  static Result<std::unique_ptr<Server>> start(server::Gateway& gateway, const server::TcpAddress& listen,
                                               const std::string& socket);
  // Ends all calls and waits until none is left, so that nobody calls into the gateway any more.
  ~Server();

  const server::TcpAddress& listen() const { return listen_; }  // with the port really taken
  const std::string& socket() const { return socket_; }

 private:
  Server(server::Gateway& gateway, server::TcpAddress listen, std::string socket);
  Result<void> build();

  server::TcpAddress listen_;
  std::string socket_;
  StreamLimit streams_;
  DeviceService devices_;
  StageService stage_;
  EventService events_;
  CommandService commands_;
  HealthService health_;
  std::unique_ptr<grpc::Server> server_;
};

}  // namespace axisgate::rpc
