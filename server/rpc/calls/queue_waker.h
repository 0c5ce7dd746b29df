// Why calls that gRPC serves do not wait 100 ms when they come a second after the last one: gRPC 1.51 lets each thread
// of its callbacks sleep for so long after a second without an event. Events come more often than that.
#pragma once

#include <grpcpp/channel.h>

#include <memory>

#include "server/events/timeouts.h"

namespace axisgate::rpc {

class QueueWaker {
 public:
  // `timeouts` outlives it. `itself` leads to the server of this process.
  QueueWaker(const std::shared_ptr<grpc::Channel>& itself, server::Timeouts& timeouts);

 private:
  class Rounds;

  const std::shared_ptr<Rounds> rounds_;
};

}  // namespace axisgate::rpc
