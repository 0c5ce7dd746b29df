#include "clients/cpp/src/identity.h"

#include <fmt/format.h>

#include <array>
#include <random>
#include <utility>

namespace axisgate::client {
namespace {

namespace intercepting = grpc::experimental;

class Identity final : public intercepting::Interceptor {
 public:
  explicit Identity(const std::string& token) : token_(token) {}

  void Intercept(intercepting::InterceptorBatchMethods* batch) override {
    static const std::string session = new_uuid();
    if (batch->QueryInterceptionHookPoint(intercepting::InterceptionHookPoints::PRE_SEND_INITIAL_METADATA)) {
      batch->GetSendInitialMetadata()->insert({"axisgate-session", session});
      if (!token_.empty()) batch->GetSendInitialMetadata()->insert({"authorization", token_});
    }
    batch->Proceed();
  }

 private:
  const std::string token_;
};

class IdentityFactory final : public intercepting::ClientInterceptorFactoryInterface {
 public:
  explicit IdentityFactory(std::string token) : token_(std::move(token)) {}

  // gRPC takes ownership of the interceptor.
  intercepting::Interceptor* CreateClientInterceptor(intercepting::ClientRpcInfo*) override {
    return new Identity(token_);
  }

 private:
  const std::string token_;
};

}  // namespace

Interceptors identifying(const std::string& token) {
  Interceptors interceptors;
  interceptors.push_back(std::make_unique<IdentityFactory>(token.empty() ? "" : "Bearer " + token));
  return interceptors;
}

std::string new_uuid() {
  std::random_device random;
  std::array<unsigned, 4> word;
  for (unsigned& one : word) one = random();
  // Version 4, variant 1 (RFC 9562, section 5.4).
  return fmt::format("{:08x}-{:04x}-4{:03x}-{:04x}-{:04x}{:08x}", word[0], word[1] >> 16, word[1] & 0xfffU,
                     (word[2] >> 16 & 0x3fffU) | 0x8000U, word[2] & 0xffffU, word[3]);
}

}  // namespace axisgate::client
