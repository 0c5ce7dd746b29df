#include "server/rpc/call_limits.h"

#include "server/rpc/gatekeeper.h"
#include "server/rpc/method_kinds.h"

namespace axisgate::rpc {
namespace {

namespace intercepting = grpc::experimental;

// From a call's arrival until gRPC has let go of it: what nobody reads takes up memory until then.
class OpenCall final : public intercepting::Interceptor {
 public:
  OpenCall(api::Admission& admission, api::RequestKind kind, intercepting::ServerRpcInfo& call)
      : admission_(admission), kind_(kind), call_(call) {}

  void Intercept(intercepting::InterceptorBatchMethods* batch) override {
    // Who calls is not known before.
    if (batch->QueryInterceptionHookPoint(intercepting::InterceptionHookPoints::POST_RECV_INITIAL_METADATA)) {
      place_ = admission_.take_place(kind_, identity(*call_.server_context()));
    }
    batch->Proceed();
  }

 private:
  api::Admission& admission_;
  const api::RequestKind kind_;
  intercepting::ServerRpcInfo& call_;
  api::Admission::Place place_;
};

class Factory final : public intercepting::ServerInterceptorFactoryInterface {
 public:
  explicit Factory(api::Admission& admission) : admission_(admission) {}

  // gRPC owns it; null: the call is not intercepted.
  intercepting::Interceptor* CreateServerInterceptor(intercepting::ServerRpcInfo* call) override {
    const api::RequestKind kind = kind_of(call->method());
    return api::rule_of(kind).quota == api::Quota::none ? nullptr : new OpenCall(admission_, kind, *call);
  }

 private:
  api::Admission& admission_;
};

}  // namespace

std::unique_ptr<intercepting::ServerInterceptorFactoryInterface> counting_interceptor(api::Admission& admission) {
  return std::make_unique<Factory>(admission);
}

}  // namespace axisgate::rpc
