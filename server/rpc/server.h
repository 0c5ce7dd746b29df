// The gRPC server with all services, on a loopback address, a Unix socket and, if configured, the network.
#pragma once

#include <grpcpp/server.h>

#include <memory>
#include <optional>
#include <string>

#include "device/core/problem.h"
#include "server/config.h"
#include "server/connection_metrics.h"
#include "server/connections/acceptor.h"
#include "server/connections/callers.h"
#include "server/gateway.h"
#include "server/listener.h"
#include "server/rpc/access_service.h"
#include "server/rpc/call_limits.h"
#include "server/rpc/command_service.h"
#include "server/rpc/control_service.h"
#include "server/rpc/device_service.h"
#include "server/rpc/diagnostics_service.h"
#include "server/rpc/entrances.h"
#include "server/rpc/event_service.h"
#include "server/rpc/health_service.h"
#include "server/rpc/position_service.h"
#include "server/rpc/rpc_metrics.h"
#include "server/rpc/setting_service.h"
#include "server/rpc/simulator_service.h"
#include "server/rpc/stage_service.h"
#include "server/rpc/stop_only.h"
#include "server/rpc/stream_limit.h"

namespace axisgate::rpc {

class Server {
 public:
  // Serves at once where the gateway's configuration says. Refuses an address that somebody else serves, and a socket
  // whose directory cannot be trusted. Connections beyond `limits` are served a stop only (stop_only.h). `gateway` and
  // `access` outlive the server, and `positions` the gateway.
  static Result<std::unique_ptr<Server>> start(server::Gateway& gateway, server::Access& access,
                                               server::SavedPositions& positions,
                                               const server::ConnectionLimits& limits);
  // Ends all calls and waits until none is left, so that nobody calls into the gateway any more.
  ~Server();

  const server::TcpAddress& listen() const { return listener_->address(); }  // with the port really taken
  const std::string& socket() const { return listener_->socket(); }
  const std::optional<server::TcpAddress>& network() const { return listener_->network(); }
  server::ConnectionCounts connections() { return listener_->counts(); }  // from any thread

 private:
  // A gRPC server and the ways into it.
  struct Part {
    std::unique_ptr<grpc::Server> server;
    std::optional<Entrances> entrances;
  };

  Server(server::Gateway& gateway, server::Access& access, server::SavedPositions& positions,
         std::unique_ptr<server::Listener> listener);
  void build_ordinary();
  void build_reserve();
  void build(grpc::ServerBuilder& builder, Part& part);

  const server::Access& access_;
  const std::optional<server::NetworkConfig> network_;
  const int message_bytes_max_;
  std::unique_ptr<server::Listener> listener_;
  std::optional<server::ConnectionMetrics> connection_metrics_;  // none before the listener has started
  RpcMetrics rpc_metrics_;
  CallLimits call_limits_;
  server::CallerSlots callers_;
  StreamLimit streams_;
  DeviceService devices_;
  StageService stage_;
  EventService events_;
  CommandService commands_;
  SettingService settings_;
  SimulatorService simulators_;
  PositionService positions_;
  DiagnosticsService diagnostics_;
  ControlService control_;
  AccessService known_callers_;
  HealthService health_;
  StopService stops_;
  NamesService names_;
  RefusingService refusing_;
  // Two, since how long a connection may be idle is a matter of the whole server.
  Part ordinary_;
  Part reserve_;
};

}  // namespace axisgate::rpc
