// Regular wake-ups of gRPC's callback threads. After a second without an event, gRPC 1.51 lets each of these threads
// sleep for 100 ms, which would delay the next call. The wake-ups keep events less than a second apart.
#pragma once

#include <grpcpp/channel.h>

#include <memory>

#include "server/events/timeouts.h"

namespace axisgate::rpc {

class QueueWaker {
 public:
  // `timeouts` must outlive this object. `itself` leads to the server of this process.
  QueueWaker(const std::shared_ptr<grpc::Channel>& itself, server::Timeouts& timeouts);

 private:
  class Rounds;

  const std::shared_ptr<Rounds> rounds_;
};

}  // namespace axisgate::rpc
