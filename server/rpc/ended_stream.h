// A stream that ends at once, most often with a problem.
#pragma once

#include <grpcpp/support/server_callback.h>

#include "server/rpc/status.h"

namespace axisgate::rpc {

template <class Response>
class EndedStream final : public grpc::ServerWriteReactor<Response> {
 public:
  explicit EndedStream(const grpc::Status& status) { this->Finish(status); }
  explicit EndedStream(const Problem& problem, const Metadata& metadata = {})
      : EndedStream(to_status(problem, metadata)) {}
  void OnDone() override { delete this; }
};

}  // namespace axisgate::rpc
