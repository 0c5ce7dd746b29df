#include "server/rpc/services/health_service.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "server/rpc/calls/call.h"
#include "server/rpc/calls/ended_stream.h"
#include "server/rpc/calls/pull_stream.h"
#include "server/rpc/calls/status.h"
#include "server/rpc/calls/unary_call.h"
#include "server/rpc/services.h"

namespace axisgate::rpc {
namespace {

using grpc::health::v1::HealthCheckRequest;
using grpc::health::v1::HealthCheckResponse;

// An empty name means the whole server.
bool is_service(std::string_view name) {
  return name.empty() || std::find(kApiServices.begin(), kApiServices.end(), name) != kApiServices.end();
}

// A HealthWatch sends one status, which never changes. The stream ends with the call, or when the caller's token ends.
class HealthWatch final : public PullStream<grpc::ServerWriteReactor<HealthCheckResponse>, HealthCheckResponse> {
 public:
  static HealthWatch* start(HealthCheckResponse::ServingStatus status, api::Streams::Place place) {
    std::shared_ptr<HealthWatch> watch(new HealthWatch(status, std::move(place)));
    watch->open();
    watch->place_->on_cut_off([stream = watch->weak_from_this()] {
      if (const auto still = stream.lock()) still->pump();
    });
    watch->pump();
    return watch.get();
  }

 private:
  HealthWatch(HealthCheckResponse::ServingStatus status, api::Streams::Place place)
      : status_(status), place_(std::move(place)) {}

  Next next() override {
    if (const auto cut = place_->cut_off()) return to_status(cut->why);
    if (std::exchange(reported_, true)) return Wait{};
    HealthCheckResponse response;
    response.set_status(status_);
    return response;
  }

  const HealthCheckResponse::ServingStatus status_;
  const api::Streams::Place place_;
  bool reported_ = false;
};

}  // namespace

grpc::ServerUnaryReactor* HealthService::Check(grpc::CallbackServerContext*, const HealthCheckRequest* request,
                                               HealthCheckResponse* response) {
  const auto call = UnaryCall<HealthCheckResponse>::start(response);
  if (!is_service(request->service())) {
    return call->refuse({.reason = Reason::not_found, .message = "no service of that name is served here"});
  }
  call->answer([](HealthCheckResponse& answer) { answer.set_status(HealthCheckResponse::SERVING); });
  return call.get();
}

grpc::ServerWriteReactor<HealthCheckResponse>* HealthService::Watch(grpc::CallbackServerContext* context,
                                                                    const HealthCheckRequest* request) {
  Result<api::Streams::Place> place =
      streams_.take(api::RequestKind::watch_server, api::name_of(credential_of(*context)));
  if (!place) return new EndedStream<grpc::ServerWriteReactor<HealthCheckResponse>>(place.error());
  const bool known = is_service(request->service());
  return HealthWatch::start(known ? HealthCheckResponse::SERVING : HealthCheckResponse::SERVICE_UNKNOWN,
                            *std::move(place));
}

}  // namespace axisgate::rpc
