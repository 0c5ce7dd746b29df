#include "server/rpc/control_service.h"

#include <chrono>
#include <memory>
#include <utility>

#include "server/rpc/call.h"
#include "server/rpc/ended_stream.h"
#include "server/rpc/lease_news.h"
#include "server/rpc/lease_streams.h"
#include "server/rpc/unary_call.h"

namespace axisgate::rpc {
namespace {

using server::Lease;
using server::LeaseTerms;
using stage::StageController;

constexpr Duration kWaitMax = std::chrono::hours(24);

// Acquiring and taking over alike: what they ask for.
struct Wish {
  server::Device* device = nullptr;
  LeaseTerms terms;
  stage::RequestContext asked;
};

template <class Request>
Result<Wish> to_wish(const server::Gateway& gateway, const grpc::CallbackServerContext& call, const Request& request) {
  const Result<server::Device*> device = find_device(gateway, request.device());
  if (!device) return tl::unexpected(device.error());
  Result<LeaseTerms> terms = to_terms(request.terms());
  if (!terms) return tl::unexpected(terms.error());
  Result<stage::RequestContext> asked = mutation_context(call, request.context());
  if (!asked) return tl::unexpected(asked.error());
  return Wish{*device, *std::move(terms), *std::move(asked)};
}

// Tells the caller. One who has gone meanwhile does not keep what nobody would give back.
template <class Response>
server::Leases::OnLease tell(const std::shared_ptr<UnaryCall<Response>>& call, server::Device& device) {
  return [call, &device](const Result<Lease>& lease) {
    if (!lease) {
      call->refuse(lease.error());
      return;
    }
    const bool told = call->try_answer([&](Response& answer) { *answer.mutable_lease() = to_proto(*lease); });
    if (told) return;
    device.post([&device, token = lease->token](StageController&, TimePoint later) {
      (void)device.leases().release(token, later);
    });
  };
}

}  // namespace

grpc::ServerUnaryReactor* ControlService::AcquireLease(grpc::CallbackServerContext* context,
                                                       const api::AcquireLeaseRequest* request,
                                                       api::AcquireLeaseResponse* response) {
  const auto call = UnaryCall<api::AcquireLeaseResponse>::start(response);
  const Result<Wish> wish = to_wish(gateway_, *context, *request);
  if (!wish) return call->refuse(wish.error());
  const Result<Duration> wait = to_span(request->wait(), kWaitMax, "wait");
  if (!wait) return call->refuse(wait.error());
  if (request->validate_only()) {
    call->answer([](api::AcquireLeaseResponse&) {});
    return call.get();
  }
  server::Device& device = *wish->device;
  device.post([call, &device, wish = *wish, wait = *wait](StageController&, TimePoint now) {
    const std::uint64_t id = device.leases().acquire(wish.terms, wish.asked.who, wait > Duration::zero(), now + wait,
                                                     now, tell(call, device));
    if (id == 0) return;
    call->when_cancelled([&device, id] {
      device.post([&device, id](StageController&, TimePoint later) { device.leases().withdraw(id, later); });
    });
  });
  return call.get();
}

grpc::ServerBidiReactor<api::KeepLeaseAliveRequest, api::KeepLeaseAliveResponse>* ControlService::KeepLeaseAlive(
    grpc::CallbackServerContext*) {
  return LeaseKeeping::start(gateway_, streams_.take());
}

grpc::ServerUnaryReactor* ControlService::ReleaseLease(grpc::CallbackServerContext*,
                                                       const api::ReleaseLeaseRequest* request,
                                                       api::ReleaseLeaseResponse* response) {
  const auto call = UnaryCall<api::ReleaseLeaseResponse>::start(response);
  const Result<server::Device*> device = find_device(gateway_, request->device());
  if (!device) return call->refuse(device.error());
  (*device)->post(
      [call, &device = **device, token = request->context().lease_token()](StageController&, TimePoint now) {
        const Result<void> done = device.leases().release(token, now);
        done ? call->answer([](api::ReleaseLeaseResponse&) {}) : static_cast<void>(call->refuse(done.error()));
      });
  return call.get();
}

grpc::ServerUnaryReactor* ControlService::HandOverLease(grpc::CallbackServerContext*,
                                                        const api::HandOverLeaseRequest* request,
                                                        api::HandOverLeaseResponse* response) {
  const auto call = UnaryCall<api::HandOverLeaseResponse>::start(response);
  const Result<server::Device*> device = find_device(gateway_, request->device());
  if (!device) return call->refuse(device.error());
  (*device)->post([call, &device = **device, token = request->context().lease_token(), to = request->to()](
                      StageController&, TimePoint now) {
    const Result<void> done = device.leases().hand_over(token, to, now);
    done ? call->answer([](api::HandOverLeaseResponse&) {}) : static_cast<void>(call->refuse(done.error()));
  });
  return call.get();
}

grpc::ServerUnaryReactor* ControlService::TakeOverLease(grpc::CallbackServerContext* context,
                                                        const api::TakeOverLeaseRequest* request,
                                                        api::TakeOverLeaseResponse* response) {
  const auto call = UnaryCall<api::TakeOverLeaseResponse>::start(response);
  const Result<Wish> wish = to_wish(gateway_, *context, *request);
  if (!wish) return call->refuse(wish.error());
  if (request->validate_only()) {
    call->answer([](api::TakeOverLeaseResponse&) {});
    return call.get();
  }
  server::Device& device = *wish->device;
  device.post([call, &device, wish = *wish](StageController&, TimePoint now) {
    device.leases().take_over(wish.terms, wish.asked.who, now, tell(call, device));
  });
  return call.get();
}

grpc::ServerWriteReactor<api::WatchLeasesResponse>* ControlService::WatchLeases(
    grpc::CallbackServerContext*, const api::WatchLeasesRequest* request) {
  using Ended = EndedStream<api::WatchLeasesResponse>;
  const Result<server::Device*> device = find_device(gateway_, request->device());
  if (!device) return new Ended(device.error());
  Result<StreamLimit::Place> place = streams_.take();
  if (!place) return new Ended(place.error());
  return LeaseWatch::start(**device, *std::move(place));
}

grpc::ServerUnaryReactor* ControlService::Rearm(grpc::CallbackServerContext* context, const api::RearmRequest* request,
                                                api::RearmResponse* response) {
  const auto call = UnaryCall<api::RearmResponse>::start(response);
  const Result<server::Device*> device = find_device(gateway_, request->device());
  if (!device) return call->refuse(device.error());
  const Result<stage::RequestContext> asked = mutation_context(*context, request->context());
  if (!asked) return call->refuse(asked.error());
  (*device)->post([call, &device = **device, asked = *asked](StageController&, TimePoint now) {
    const Result<stage::AxisSet> lifted = device.leases().rearm(asked.lease, asked.who, now);
    if (!lifted) {
      call->refuse(lifted.error());
      return;
    }
    call->answer([&](api::RearmResponse& answer) {
      for (const int axis : lifted->list()) answer.add_axes(axis);
    });
  });
  return call.get();
}

}  // namespace axisgate::rpc
