// Where connections that the daemon accepted enter a gRPC server.
#pragma once

#include <grpcpp/server_builder.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "device/link/descriptor.h"
#include "server/config/config.h"
#include "server/connections/acceptor.h"
#include "server/connections/callers.h"
#include "server/rpc/gatekeeper.h"

namespace axisgate::rpc {

// One for loopback, one for each slot of Unix callers, and one for the network, if it is served. Used by the thread
// that accepts.
class Endpoints {
 public:
  // Adds them to what `builder` builds. `callers` and what `gate` names outlive that server.
  Endpoints(grpc::ServerBuilder& builder, const server::CallerSlots& callers, const Gate& gate,
            const std::optional<server::NetworkConfig>& network);

  // The connection is gRPC's from here on; `slot` is the Unix caller's. Before the server has started, or once it has
  // been shut down, the descriptor leaks: gRPC drops it without closing it.
  void enter(Descriptor connection, server::Acceptor::Origin origin, std::optional<std::size_t> slot);

 private:
  using Endpoint = std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor>;

  Endpoint loopback_;
  Endpoint network_;  // null: not served
  std::vector<Endpoint> unix_;
};

}  // namespace axisgate::rpc
