// The gRPC server with all services, on a loopback address, a Unix socket and, if configured, the network. What it is
// made of stands in server.cc: gRPC's headers take longer to read than everything else of a file that needs a Server.
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
  // Serves at once where the gateway's configuration says. Refuses an address that somebody else serves, and a socket
  // whose directory cannot be trusted. Connections beyond `limits` are served a stop only. `gateway` outlives the
  // server, and `access` and `positions` the gateway.
  static Result<std::unique_ptr<Server>> start(server::Gateway& gateway, server::Access& access,
                                               server::SavedPositions& positions,
                                               const server::ConnectionLimits& limits);
  // Ends all calls and waits until none is left, so that nobody calls into the gateway any more.
  ~Server();

  const server::TcpAddress& listen() const;  // with the port really taken
  const std::string& socket() const;
  const std::optional<server::TcpAddress>& network() const;
  server::ConnectionCounts connections();  // from any thread

  // Those that serve connections and calls, as long as the server lives.
  std::vector<server::Watchdog::Thread> threads();

 private:
  class Services;
  explicit Server(std::unique_ptr<Services> services);

  std::unique_ptr<Services> services_;
};

}  // namespace axisgate::rpc
