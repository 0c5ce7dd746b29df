// A stream that ends at once, usually with a problem.
#pragma once

#include <grpcpp/support/status.h>

#include "server/rpc/calls/status.h"

namespace axisgate::rpc {

// `Reactor` is a grpc::ServerWriteReactor or ServerBidiReactor.
template <class Reactor>
class EndedStream final : public Reactor {
 public:
  explicit EndedStream(const grpc::Status& status) { this->Finish(status); }
  explicit EndedStream(const Problem& problem) : EndedStream(to_status(problem)) {}
  void OnDone() override { delete this; }
};

}  // namespace axisgate::rpc
