// The gRPC door: the gRPC server with all services, and the answers that the front needs from it. Its members are in
// grpc_door.cc, because gRPC's headers would slow the compilation of every file that includes this one.
#pragma once

#include <memory>

#include "device/core/problem.h"
#include "device/link/descriptor.h"
#include "server/api/api.h"
#include "server/front/call_filter.h"
#include "server/front/closing.h"
#include "server/gateway.h"
#include "server/watchdog.h"

namespace axisgate::rpc {

class GrpcDoor {
 public:
  // Creates the door; it serves nothing before start(). `gateway` and `api` must outlive it.
  GrpcDoor(server::Gateway& gateway, api::Api& api);
  // Calls end().
  ~GrpcDoor();

  // Starts gRPC, with messages of at most the configured size. Fails with internal if gRPC does not start.
  Result<void> start();
  // Serves a connection in clear HTTP/2 whose calls `filter()` has let in. Must be called before end().
  void enter(Descriptor connection);
  // Ends all calls and waits until none is left. No call reaches the gateway after that. A second call has no effect.
  void end();

  // Decides on calls and answers some itself, on the strand of the front.
  front::CallFilter& filter();
  // Counts and logs a connection that the front closed for a reason. Thread safe.
  void note(const front::Peer& peer, const front::Closing& closing);
  // Returns gRPC's threads, watched as one. Call it after start(); valid as long as this object lives.
  server::Watchdog::Thread thread();

 private:
  class Members;

  const std::unique_ptr<Members> members_;
};

}  // namespace axisgate::rpc
