#include "server/rpc/gate/rpc_metrics.h"

#include <array>
#include <utility>

#include "server/rpc/services.h"

namespace axisgate::rpc {
namespace {

namespace intercepting = grpc::experimental;

// Names of the codes, indexed by grpc::StatusCode.
constexpr std::array<std::string_view, 17> kCodes = {
    "OK",        "CANCELLED",      "UNKNOWN",           "INVALID_ARGUMENT",   "DEADLINE_EXCEEDED",
    "NOT_FOUND", "ALREADY_EXISTS", "PERMISSION_DENIED", "RESOURCE_EXHAUSTED", "FAILED_PRECONDITION",
    "ABORTED",   "OUT_OF_RANGE",   "UNIMPLEMENTED",     "INTERNAL",           "UNAVAILABLE",
    "DATA_LOSS", "UNAUTHENTICATED"};
static_assert(kCodes[grpc::RESOURCE_EXHAUSTED] == "RESOURCE_EXHAUSTED");
static_assert(kCodes[grpc::UNAUTHENTICATED] == "UNAUTHENTICATED");

prometheus::Labels labels(const std::string& method, grpc::StatusCode code) {
  return {{"method", method}, {"code", std::string(kCodes.at(static_cast<std::size_t>(code)))}};
}

}  // namespace

RpcMetrics::Call::Call(RpcMetrics& metrics, const Entry& method) : metrics_(metrics), method_(method) {
  if (method_.second.open != nullptr) method_.second.open->Increment();
}

void RpcMetrics::Call::ended(grpc::StatusCode code) {
  if (!open_.exchange(false)) return;
  (code == grpc::OK ? method_.second.succeeded : metrics_.calls_.Add(labels(method_.first, code))).Increment();
  if (method_.second.open != nullptr) method_.second.open->Decrement();
}

// A CallCount is one call that gRPC serves, until its status is sent.
class RpcMetrics::CallCount final : public intercepting::Interceptor {
 public:
  CallCount(RpcMetrics& metrics, const Entry& method) : call_(metrics, method) {}

  void Intercept(intercepting::InterceptorBatchMethods* batch) override {
    if (batch->QueryInterceptionHookPoint(intercepting::InterceptionHookPoints::PRE_SEND_STATUS)) {
      call_.ended(batch->GetSendStatus().error_code());
    }
    batch->Proceed();
  }

 private:
  Call call_;
};

class RpcMetrics::Factory final : public intercepting::ServerInterceptorFactoryInterface {
 public:
  explicit Factory(RpcMetrics& metrics) : metrics_(metrics) {}

  // gRPC owns the result. Null: the call is not intercepted.
  intercepting::Interceptor* CreateServerInterceptor(intercepting::ServerRpcInfo* call) override {
    const auto found = metrics_.methods_.find(without_slash(call->method()));
    return found == metrics_.methods_.end() ? nullptr : new CallCount(metrics_, *found);
  }

 private:
  RpcMetrics& metrics_;
};

RpcMetrics::RpcMetrics(prometheus::Registry& registry)
    : calls_(prometheus::BuildCounter()
                 .Name("axisgate_rpcs_total")
                 .Help("Calls that ended, by method and gRPC status code; a stream counts when it ends.")
                 .Register(registry)),
      open_streams_(prometheus::BuildGauge()
                        .Name("axisgate_open_streams")
                        .Help("Streams that are open, by method.")
                        .Register(registry)) {
  for (const ServedMethod& method : served_methods()) {
    prometheus::Gauge* open = method.streams ? &open_streams_.Add({{"method", method.name}}) : nullptr;
    methods_.try_emplace(method.name, Method{calls_.Add(labels(method.name, grpc::OK)), open});
  }
}

std::unique_ptr<intercepting::ServerInterceptorFactoryInterface> RpcMetrics::interceptor() {
  return std::make_unique<Factory>(*this);
}

void RpcMetrics::count(std::string_view path, grpc::StatusCode code) {
  const auto found = methods_.find(without_slash(path));
  if (found != methods_.end()) calls_.Add(labels(found->first, code)).Increment();
}

}  // namespace axisgate::rpc
