// Where connections that the daemon accepted enter a gRPC server.
#pragma once

#include <grpcpp/server_builder.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "device/link/descriptor.h"
#include "server/access/access.h"
#include "server/connections/callers.h"

namespace axisgate::rpc {

// One for TCP and one for each slot of Unix callers. Used by the thread that accepts.
class Entrances {
 public:
  // Adds them to what `builder` builds. Both others outlive that server.
  Entrances(grpc::ServerBuilder& builder, const server::CallerSlots& callers, const server::Access& access);

  // The connection is gRPC's from here on; `slot` is the Unix caller's. Before the server has started, or once it has
  // been shut down, the descriptor leaks: gRPC drops it without closing it.
  void enter(Descriptor connection, std::optional<std::size_t> slot);

 private:
  using Entrance = std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor>;

  Entrance tcp_;
  std::vector<Entrance> unix_;
};

}  // namespace axisgate::rpc
