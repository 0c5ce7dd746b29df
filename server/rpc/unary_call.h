// One call with one answer, which may come from another thread and after the caller has gone.
#pragma once

#include <grpcpp/support/server_callback.h>

#include <atomic>
#include <memory>
#include <utility>

#include "server/rpc/status.h"

namespace axisgate::rpc {

// Whoever may still answer holds a shared pointer; the first of answer(), refuse() and the caller's cancelling counts.
template <class Response>
class UnaryCall final : public grpc::ServerUnaryReactor {
 public:
  using Handle = std::shared_ptr<UnaryCall>;

  static Handle start(Response* response) {
    Handle call(new UnaryCall(response));
    call->self_ = call;
    return call;
  }

  // `fill` is called with the response to fill, or not at all.
  template <class Fill>
  void answer(Fill&& fill) {
    if (ended_.exchange(true)) return;
    fill(*response_);
    Finish(grpc::Status::OK);
  }

  // Returns the reactor, so that a handler can end with it.
  UnaryCall* refuse(const Problem& problem) {
    if (!ended_.exchange(true)) Finish(to_status(problem));
    return this;
  }

  void OnCancel() override {
    if (!ended_.exchange(true)) Finish(grpc::Status::CANCELLED);
  }

  void OnDone() override { self_.reset(); }

 private:
  explicit UnaryCall(Response* response) : response_(response) {}

  std::atomic<bool> ended_ = false;
  Response* response_;  // gRPC's, until Finish()
  Handle self_;
};

}  // namespace axisgate::rpc
