// ControlService: leases, and the latches that other callers' stops set.
#include <memory>
#include <utility>

#include "axisgate/v1/control.grpc.pb.h"
#include "server/api/request/axis_names.h"
#include "server/api/sharing/leases.h"
#include "server/proto/amounts.h"
#include "server/proto/lease_to_proto.h"
#include "server/rpc/calls/call.h"
#include "server/rpc/calls/lease_keeping.h"
#include "server/rpc/calls/subscribed_stream.h"
#include "server/rpc/calls/unary_call.h"
#include "server/rpc/services.h"

namespace axisgate::rpc {
namespace {

// Builds the Call of a request whose subject is the lease of its context, so requests for two leases differ.
template <class Request>
api::Call to_lease_call(const grpc::CallbackServerContext& context, const Request& request) {
  api::Call made = to_call(context, request.context());
  if (!made.request_id.empty()) made.digest = proto::digest_of(request.context().lease_token(), request);
  return made;
}

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

class ControlService final : public v1::ControlService::CallbackService {
 public:
  // The referenced objects must outlive this one.
  ControlService(const server::Gateway& gateway, const api::Leases& leases) : gateway_(gateway), leases_(leases) {}

  grpc::ServerUnaryReactor* AcquireLease(grpc::CallbackServerContext* context, const v1::AcquireLeaseRequest* request,
                                         v1::AcquireLeaseResponse* response) override {
    const auto call = UnaryCall<v1::AcquireLeaseResponse>::start(response);
    leases_.acquire(to_checked_call(*context, *request), request->device(),
                    proto::to_wish(request->terms(), api::axis_names(gateway_, request->device())),
                    proto::to_duration(request->wait()), std::make_shared<WaitingCall<v1::AcquireLeaseResponse>>(call));
    return call.get();
  }

  grpc::ServerBidiReactor<v1::KeepLeaseAliveRequest, v1::KeepLeaseAliveResponse>* KeepLeaseAlive(
      grpc::CallbackServerContext* context) override {
    using Reactor = grpc::ServerBidiReactor<v1::KeepLeaseAliveRequest, v1::KeepLeaseAliveResponse>;
    auto keeping = leases_.keep_alive(to_call(*context));
    if (!keeping) return new EndedStream<Reactor>(keeping.error());
    return LeaseKeeping::start(*std::move(keeping));
  }

  grpc::ServerUnaryReactor* RenewLease(grpc::CallbackServerContext* context, const v1::RenewLeaseRequest* request,
                                       v1::RenewLeaseResponse* response) override {
    const auto call = UnaryCall<v1::RenewLeaseResponse>::start(response);
    leases_.renew(to_call(*context, request->context()), request->device(),
                  answering<server::Lease>(call, [](v1::RenewLeaseResponse& answer, const server::Lease& lease) {
                    *answer.mutable_lease() = proto::to_proto(lease);
                  }));
    return call.get();
  }

  grpc::ServerUnaryReactor* ReleaseLease(grpc::CallbackServerContext* context, const v1::ReleaseLeaseRequest* request,
                                         v1::ReleaseLeaseResponse* response) override {
    const auto call = UnaryCall<v1::ReleaseLeaseResponse>::start(response);
    leases_.release(to_lease_call(*context, *request), request->device(), answering(call));
    return call.get();
  }

  grpc::ServerUnaryReactor* HandOverLease(grpc::CallbackServerContext* context, const v1::HandOverLeaseRequest* request,
                                          v1::HandOverLeaseResponse* response) override {
    const auto call = UnaryCall<v1::HandOverLeaseResponse>::start(response);
    leases_.hand_over(to_lease_call(*context, *request), request->device(), request->caller(), answering(call));
    return call.get();
  }

  grpc::ServerUnaryReactor* TakeOverLease(grpc::CallbackServerContext* context, const v1::TakeOverLeaseRequest* request,
                                          v1::TakeOverLeaseResponse* response) override {
    const auto call = UnaryCall<v1::TakeOverLeaseResponse>::start(response);
    leases_.take_over(to_checked_call(*context, *request), request->device(),
                      proto::to_wish(request->terms(), api::axis_names(gateway_, request->device())),
                      std::make_shared<WaitingCall<v1::TakeOverLeaseResponse>>(call));
    return call.get();
  }

  grpc::ServerWriteReactor<v1::WatchLeasesResponse>* WatchLeases(grpc::CallbackServerContext* context,
                                                                 const v1::WatchLeasesRequest* request) override {
    return serve<v1::WatchLeasesResponse>(
        leases_.watch(to_call(*context), request->device()),
        [](v1::WatchLeasesResponse& response, const api::Board& board) { response = proto::to_proto(*board); });
  }

  grpc::ServerUnaryReactor* Rearm(grpc::CallbackServerContext* context, const v1::RearmRequest* request,
                                  v1::RearmResponse* response) override {
    const auto call = UnaryCall<v1::RearmResponse>::start(response);
    leases_.rearm(to_acting_call(*context, *request), request->device(),
                  answering<std::vector<server::Latch>>(
                      call, [](v1::RearmResponse& answer, const std::vector<server::Latch>& lifted) {
                        answer = proto::to_proto(lifted);
                      }));
    return call.get();
  }

 private:
  const server::Gateway& gateway_;
  const api::Leases& leases_;
};

}  // namespace

std::unique_ptr<grpc::Service> control_service(const ServiceParts& parts) {
  return std::make_unique<ControlService>(parts.gateway, parts.api.leases);
}

}  // namespace axisgate::rpc
