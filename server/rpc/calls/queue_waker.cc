#include "server/rpc/calls/queue_waker.h"

#include <grpcpp/generic/generic_stub.h>

#include <chrono>

#include "server/limits.h"

namespace axisgate::rpc {
namespace {

// Unserved method, so the calls are neither counted nor logged.
constexpr const char* kMethod = "/axisgate.QueueWaker/Wake";

}  // namespace

class QueueWaker::Rounds : public std::enable_shared_from_this<Rounds> {
 public:
  Rounds(const std::shared_ptr<grpc::Channel>& itself, server::Timeouts& timeouts)
      : stub_(itself), timeouts_(timeouts) {}

  void next() {
    timeouts_.after(server::kQueueWakeUp, [weak = weak_from_this()] {
      const auto self = weak.lock();
      if (!self) return;
      self->wake();
      self->next();
    });
  }

 private:
  struct Call {
    grpc::ClientContext context;
    grpc::Slice nothing;
    grpc::ByteBuffer request{&nothing, 1};
    grpc::ByteBuffer response;
  };

  void wake() {
    const auto call = std::make_shared<Call>();
    stub_.UnaryCall(&call->context, kMethod, {}, &call->request, &call->response, [call](const grpc::Status&) {});
  }

  grpc::GenericStub stub_;
  server::Timeouts& timeouts_;
};

QueueWaker::QueueWaker(const std::shared_ptr<grpc::Channel>& itself, server::Timeouts& timeouts)
    : rounds_(std::make_shared<Rounds>(itself, timeouts)) {
  rounds_->next();
}

}  // namespace axisgate::rpc
