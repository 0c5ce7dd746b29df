// The gRPC server with all services, on a loopback address, a Unix socket and, if configured, the network. Its members
// are in server.cc, because gRPC's headers would slow the compilation of every file that includes this one.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "device/core/problem.h"
#include "server/access/access.h"
#include "server/config/config.h"
#include "server/connections/acceptor.h"
#include "server/devices/saved_positions.h"
#include "server/gateway.h"
#include "server/watchdog.h"

namespace axisgate::rpc {

class Server {
 public:
  // Serves at once at the addresses of the gateway's configuration. Fails if another process serves an address, or if a
  // socket's directory cannot be trusted. Connections beyond `limits` get a stop only. `gateway` must outlive the
  // server; `access` and `positions` must outlive the gateway.
  static Result<std::unique_ptr<Server>> start(server::Gateway& gateway, server::Access& access,
                                               server::SavedPositions& positions,
                                               const server::ConnectionLimits& limits);
  // Ends all calls and waits until none is left. No call reaches the gateway after that.
  ~Server();

  const server::TcpAddress& listen() const;  // with the port actually taken
  const std::string& socket() const;
  const std::optional<server::TcpAddress>& network() const;
  server::ConnectionCounts connections();  // thread safe

  // Threads that serve connections and calls; valid as long as the server lives.
  std::vector<server::Watchdog::Thread> threads();

 private:
  class Services;
  explicit Server(std::unique_ptr<Services> services);

  std::unique_ptr<Services> services_;
};

}  // namespace axisgate::rpc
