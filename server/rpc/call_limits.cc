#include "server/rpc/call_limits.h"

#include <algorithm>
#include <array>

#include "server/rpc/gatekeeper.h"
#include "server/rpc/services.h"

namespace axisgate::rpc {
namespace {

namespace intercepting = grpc::experimental;

// What a stop needs, as in the reserve (stop_only.h): a stop names its device, and whoever does not know it asks first.
constexpr std::array<std::string_view, 3> kUnlimited = {"/axisgate.v1.StageService/Stop",
                                                        "/axisgate.v1.StageService/EmergencyStop",
                                                        "/axisgate.v1.DeviceService/ListDevices"};

}  // namespace

// From a call's arrival until gRPC has let go of it: what nobody reads takes up memory until then.
class CallLimits::OpenCall final : public intercepting::Interceptor {
 public:
  OpenCall(server::IdentityLimits& limits, Kind kind, intercepting::ServerRpcInfo& call)
      : limits_(limits), kind_(kind), call_(call) {}

  void Intercept(intercepting::InterceptorBatchMethods* batch) override {
    // Who calls is not known before.
    if (batch->QueryInterceptionHookPoint(intercepting::InterceptionHookPoints::POST_RECV_INITIAL_METADATA)) {
      place_ = limits_.take(identity(*call_.server_context()), kind_);
    }
    batch->Proceed();
  }

 private:
  server::IdentityLimits& limits_;
  const Kind kind_;
  intercepting::ServerRpcInfo& call_;
  server::IdentityLimits::Place place_;
};

class CallLimits::Factory final : public intercepting::ServerInterceptorFactoryInterface {
 public:
  explicit Factory(CallLimits& limits) : limits_(limits) {}

  // gRPC owns it; null: the call is not intercepted.
  intercepting::Interceptor* CreateServerInterceptor(intercepting::ServerRpcInfo* call) override {
    const std::optional<Kind> kind = limits_.kind_of(call->method());
    return kind ? new OpenCall(limits_.limits_, *kind, *call) : nullptr;
  }

 private:
  CallLimits& limits_;
};

CallLimits::CallLimits(const server::LimitsConfig& config) : limits_(config) {
  for (const ServedMethod& method : served_methods()) {
    if (method.streams) streams_.insert("/" + method.name);
  }
}

Result<void> CallLimits::check(const std::string& who, std::string_view method) const {
  const std::optional<Kind> kind = kind_of(method);
  return kind ? limits_.check(who, *kind) : Result<void>();
}

std::unique_ptr<intercepting::ServerInterceptorFactoryInterface> CallLimits::interceptor() {
  return std::make_unique<Factory>(*this);
}

std::optional<CallLimits::Kind> CallLimits::kind_of(std::string_view method) const {
  if (std::ranges::find(kUnlimited, method) != kUnlimited.end()) return std::nullopt;
  return streams_.contains(method) ? Kind::stream : Kind::call;
}

}  // namespace axisgate::rpc
