#include "clients/axisctl/bearer.h"

#include <utility>

namespace axisgate::axisctl {
namespace {

namespace intercepting = grpc::experimental;

class Bearer final : public intercepting::Interceptor {
 public:
  explicit Bearer(std::string value) : value_(std::move(value)) {}

  void Intercept(intercepting::InterceptorBatchMethods* batch) override {
    if (batch->QueryInterceptionHookPoint(intercepting::InterceptionHookPoints::PRE_SEND_INITIAL_METADATA)) {
      batch->GetSendInitialMetadata()->insert({"authorization", value_});
    }
    batch->Proceed();
  }

 private:
  const std::string value_;
};

class Factory final : public intercepting::ClientInterceptorFactoryInterface {
 public:
  explicit Factory(std::string value) : value_(std::move(value)) {}

  // gRPC takes ownership of the interceptor.
  intercepting::Interceptor* CreateClientInterceptor(intercepting::ClientRpcInfo*) override {
    return new Bearer(value_);
  }

 private:
  const std::string value_;
};

}  // namespace

Interceptors with_bearer(const std::string& token) {
  Interceptors interceptors;
  if (!token.empty()) interceptors.push_back(std::make_unique<Factory>("Bearer " + token));
  return interceptors;
}

}  // namespace axisgate::axisctl
