// One call with one answer, which may come from another thread and after the caller has gone.
#pragma once

#include <grpcpp/support/server_callback.h>

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>

#include "server/api/request/call.h"
#include "server/rpc/calls/status.h"

namespace axisgate::rpc {

// All who may still answer keep a shared pointer. The first of answer(), refuse() and the caller's cancelling counts.
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
    (void)try_answer(std::forward<Fill>(fill));
  }
  // Like answer(); returns false if the call has already ended.
  template <class Fill>
  bool try_answer(Fill&& fill) {
    if (ended_.exchange(true)) return false;
    fill(*response_);
    Finish(grpc::Status::OK);
    return true;
  }

  // Calls `leave` once when the caller cancels before the answer, or at once if the caller has already cancelled. May
  // be called only once.
  void when_cancelled(std::function<void()> leave) {
    {
      const std::lock_guard lock(mutex_);
      if (!cancelled_) {
        leave_ = std::move(leave);
        return;
      }
    }
    leave();
  }

  // Returns the reactor, so that a handler can end with it.
  UnaryCall* refuse(const Problem& problem) {
    if (!ended_.exchange(true)) Finish(to_status(problem));
    return this;
  }

  void OnCancel() override {
    if (ended_.exchange(true)) return;
    std::function<void()> leave;
    {
      const std::lock_guard lock(mutex_);
      cancelled_ = true;
      leave = std::exchange(leave_, {});
    }
    if (leave) leave();
    Finish(grpc::Status::CANCELLED);
  }

  void OnDone() override { self_.reset(); }

 private:
  explicit UnaryCall(Response* response) : response_(response) {}

  std::atomic<bool> ended_ = false;
  std::mutex mutex_;
  std::function<void()> leave_;
  bool cancelled_ = false;
  Response* response_;  // gRPC's, until Finish()
  Handle self_;
};

// Returns an api::Answer that answers the call. `fill` is called with the response and the outcome.
template <class Outcome, class Response, class Fill>
api::Answer<Outcome> answering(std::shared_ptr<UnaryCall<Response>> call, Fill fill) {
  return [call = std::move(call), fill = std::move(fill)](const Result<Outcome>& outcome) {
    if (!outcome) return static_cast<void>(call->refuse(outcome.error()));
    call->answer([&](Response& response) { fill(response, *outcome); });
  };
}

// Like the function above, for an empty response.
template <class Response>
api::Answer<void> answering(std::shared_ptr<UnaryCall<Response>> call) {
  return [call = std::move(call)](const Result<void>& done) {
    if (!done) return static_cast<void>(call->refuse(done.error()));
    call->answer([](Response&) {});
  };
}

// Answers with an outcome that is known at once.
template <class Outcome, class Response, class Fill>
grpc::ServerUnaryReactor* answer_at_once(Response* response, const Result<Outcome>& outcome, Fill fill) {
  const auto call = UnaryCall<Response>::start(response);
  answering<Outcome>(call, std::move(fill))(outcome);
  return call.get();
}

}  // namespace axisgate::rpc
