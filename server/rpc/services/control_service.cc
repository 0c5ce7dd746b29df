#include "server/rpc/services/control_service.h"

#include <memory>
#include <utility>

#include "server/proto/amounts.h"
#include "server/proto/lease_to_proto.h"
#include "server/rpc/calls/call.h"
#include "server/rpc/calls/lease_keeping.h"
#include "server/rpc/calls/subscribed_stream.h"
#include "server/rpc/calls/unary_call.h"

namespace axisgate::rpc {
namespace {

// A WaitingCall is an open AcquireLease or TakeOverLease.
template <class Response>
class WaitingCall final : public api::LeaseSeeker {
 public:
  explicit WaitingCall(std::shared_ptr<UnaryCall<Response>> call) : call_(std::move(call)) {}

  bool answer(Result<std::optional<server::Lease>> lease) override {
    if (!lease) {
      call_->refuse(lease.error());
      return true;
    }
    return call_->try_answer([&](Response& response) {
      if (*lease) *response.mutable_lease() = proto::to_proto(**lease);
    });
  }

  void when_gone(std::function<void()> leave) override { call_->when_cancelled(std::move(leave)); }

 private:
  const std::shared_ptr<UnaryCall<Response>> call_;
};

}  // namespace

grpc::ServerUnaryReactor* ControlService::AcquireLease(grpc::CallbackServerContext* context,
                                                       const v1::AcquireLeaseRequest* request,
                                                       v1::AcquireLeaseResponse* response) {
  const auto call = UnaryCall<v1::AcquireLeaseResponse>::start(response);
  leases_.acquire(to_checked_call(*context, *request), request->device(), proto::to_wish(request->terms()),
                  proto::to_duration(request->wait()), std::make_shared<WaitingCall<v1::AcquireLeaseResponse>>(call));
  return call.get();
}

grpc::ServerBidiReactor<v1::KeepLeaseAliveRequest, v1::KeepLeaseAliveResponse>* ControlService::KeepLeaseAlive(
    grpc::CallbackServerContext* context) {
  using Reactor = grpc::ServerBidiReactor<v1::KeepLeaseAliveRequest, v1::KeepLeaseAliveResponse>;
  auto keeping = leases_.keep_alive(to_call(*context));
  if (!keeping) return new EndedStream<Reactor>(keeping.error());
  return LeaseKeeping::start(*std::move(keeping));
}

grpc::ServerUnaryReactor* ControlService::ReleaseLease(grpc::CallbackServerContext* context,
                                                       const v1::ReleaseLeaseRequest* request,
                                                       v1::ReleaseLeaseResponse* response) {
  const auto call = UnaryCall<v1::ReleaseLeaseResponse>::start(response);
  leases_.release(to_call(*context, request->context()), request->device(), answering(call));
  return call.get();
}

grpc::ServerUnaryReactor* ControlService::HandOverLease(grpc::CallbackServerContext* context,
                                                        const v1::HandOverLeaseRequest* request,
                                                        v1::HandOverLeaseResponse* response) {
  const auto call = UnaryCall<v1::HandOverLeaseResponse>::start(response);
  leases_.hand_over(to_call(*context, request->context()), request->device(), request->to(), answering(call));
  return call.get();
}

grpc::ServerUnaryReactor* ControlService::TakeOverLease(grpc::CallbackServerContext* context,
                                                        const v1::TakeOverLeaseRequest* request,
                                                        v1::TakeOverLeaseResponse* response) {
  const auto call = UnaryCall<v1::TakeOverLeaseResponse>::start(response);
  leases_.take_over(to_checked_call(*context, *request), request->device(), proto::to_wish(request->terms()),
                    std::make_shared<WaitingCall<v1::TakeOverLeaseResponse>>(call));
  return call.get();
}

grpc::ServerWriteReactor<v1::WatchLeasesResponse>* ControlService::WatchLeases(grpc::CallbackServerContext* context,
                                                                               const v1::WatchLeasesRequest* request) {
  return serve<v1::WatchLeasesResponse>(
      leases_.watch(to_call(*context), request->device()),
      [](v1::WatchLeasesResponse& response, const api::Board& board) { response = proto::to_proto(*board); });
}

grpc::ServerUnaryReactor* ControlService::Rearm(grpc::CallbackServerContext* context, const v1::RearmRequest* request,
                                                v1::RearmResponse* response) {
  const auto call = UnaryCall<v1::RearmResponse>::start(response);
  leases_.rearm(to_call(*context, request->context()), request->device(),
                answering<std::vector<server::Latch>>(
                    call, [](v1::RearmResponse& answer, const std::vector<server::Latch>& lifted) {
                      answer = proto::to_proto(lifted);
                    }));
  return call.get();
}

}  // namespace axisgate::rpc
