// gRPC's standard health service: SERVING as long as the daemon runs. DeviceService reports the state of devices.
#include <grpc/health/v1/health.grpc.pb.h>

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "server/api/request/streams.h"
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
bool is_served(std::string_view name) {
  return name.empty() ||
         (is_of_api(name) && std::ranges::find(services(), name, &ServedService::name) != services().end());
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

class HealthService final : public grpc::health::v1::Health::CallbackService {
 public:
  explicit HealthService(api::Streams& streams) : streams_(streams) {}

  grpc::ServerUnaryReactor* Check(grpc::CallbackServerContext*, const HealthCheckRequest* request,
                                  HealthCheckResponse* response) override {
    const auto call = UnaryCall<HealthCheckResponse>::start(response);
    if (!is_served(request->service())) {
      return call->refuse({.reason = Reason::not_found, .message = "no service of that name is served here"});
    }
    call->answer([](HealthCheckResponse& answer) { answer.set_status(HealthCheckResponse::SERVING); });
    return call.get();
  }

  grpc::ServerWriteReactor<HealthCheckResponse>* Watch(grpc::CallbackServerContext* context,
                                                       const HealthCheckRequest* request) override {
    Result<api::Streams::Place> place =
        streams_.take(api::RequestKind::watch_server, api::name_of(credential_of(*context)));
    if (!place) return new EndedStream<grpc::ServerWriteReactor<HealthCheckResponse>>(place.error());
    const bool known = is_served(request->service());
    return HealthWatch::start(known ? HealthCheckResponse::SERVING : HealthCheckResponse::SERVICE_UNKNOWN,
                              *std::move(place));
  }

 private:
  api::Streams& streams_;
};

}  // namespace

std::unique_ptr<grpc::Service> health_service(const ServiceParts& parts) {
  return std::make_unique<HealthService>(parts.api.streams);
}

}  // namespace axisgate::rpc
