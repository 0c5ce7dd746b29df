// The ways into the gateway, and what they share: the API, the listening sockets, and the front, which checks each
// connection before a door serves it.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "device/core/problem.h"
#include "device/link/descriptor.h"
#include "server/access/access.h"
#include "server/api/api.h"
#include "server/config/config.h"
#include "server/connections/acceptor.h"
#include "server/connections/listener.h"
#include "server/devices/saved_positions.h"
#include "server/front/front.h"
#include "server/gateway.h"
#include "server/metrics/connection_metrics.h"
#include "server/rpc/grpc_door.h"
#include "server/watchdog.h"

namespace axisgate::server {

// Serves on a loopback address, a Unix socket and, if configured, the network. Thread safe.
class Doors {
 public:
  // Serves at once at the addresses of the gateway's configuration. Fails if another process serves an address, if a
  // socket's directory cannot be trusted, or if gRPC does not start. Connections beyond `limits` get a stop only.
  // `gateway` must outlive the doors; `access` and `positions` must outlive the gateway.
  static Result<std::unique_ptr<Doors>> open(Gateway& gateway, Access& access, SavedPositions& positions,
                                             const ConnectionLimits& limits);
  // Ends all calls and waits until none is left. No call reaches the gateway after that.
  ~Doors();

  const TcpAddress& listen() const { return listener_->address(); }  // with the port actually taken
  const std::string& socket() const { return listener_->socket(); }
  const std::optional<TcpAddress>& network() const { return listener_->network(); }
  ConnectionCounts connections() { return listener_->counts(); }

  // Threads that serve connections and calls; valid as long as the doors live.
  std::vector<Watchdog::Thread> threads();

 private:
  Doors(Gateway& gateway, Access& access, SavedPositions& positions, std::unique_ptr<Listener> listener);

  Result<void> serve(Gateway& gateway, const ConnectionLimits& limits);
  void on_the_front(std::function<void(const std::function<void()>& done)> act);

  api::Api api_;
  std::unique_ptr<Listener> listener_;
  std::optional<ConnectionMetrics> connection_metrics_;  // none before the listener has started
  rpc::GrpcDoor grpc_;
  front::Front front_;
  std::atomic<bool> ending_ = false;
};

}  // namespace axisgate::server
