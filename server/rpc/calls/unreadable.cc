#include "server/rpc/calls/unreadable.h"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "server/rpc/calls/status.h"

namespace axisgate::rpc {
namespace {

namespace hooks = grpc::experimental;

// All methods are implemented, and the front refuses unknown ones, so this is gRPC's answer to a message that it could
// not parse.
bool is_unexplained(const grpc::Status& status) {
  return status.error_code() == grpc::UNIMPLEMENTED && status.error_message().empty();
}

class Explaining final : public hooks::Interceptor {
 public:
  explicit Explaining(std::string method) : method_(std::move(method)) {}

  void Intercept(hooks::InterceptorBatchMethods* batch) override {
    if (batch->QueryInterceptionHookPoint(hooks::InterceptionHookPoints::PRE_SEND_STATUS) &&
        is_unexplained(batch->GetSendStatus())) {
      batch->ModifySendStatus(to_status(not_readable(method_)));
    }
    batch->Proceed();
  }

 private:
  const std::string method_;
};

class ExplainingFactory final : public hooks::ServerInterceptorFactoryInterface {
 public:
  // gRPC owns the result.
  hooks::Interceptor* CreateServerInterceptor(hooks::ServerRpcInfo* call) override {
    return new Explaining(call->method());
  }
};

}  // namespace

Problem not_readable(std::string_view method) {
  return {.reason = Reason::invalid_request,
          .message = fmt::format("the message is not one of {}", method),
          .hint = "see that client and daemon have the same proto files"};
}

Problem not_one_message(std::string_view method) {
  return {.reason = Reason::invalid_request,
          .message = fmt::format("the request must hold exactly one whole message of {}", method),
          .hint = "send a message in gRPC's framing, five bytes for its length and then itself, also when it is empty"};
}

std::unique_ptr<hooks::ServerInterceptorFactoryInterface> unreadable_interceptor() {
  return std::make_unique<ExplainingFactory>();
}

}  // namespace axisgate::rpc
