// How many calls each caller has open, counted where gRPC hands every call through.
#pragma once

#include <grpcpp/support/server_interceptor.h>

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "device/core/problem.h"
#include "server/access/identity_limits.h"

namespace axisgate::rpc {

// A gatekeeper refuses calls but does not see them end; an interceptor sees both ends but refuses nothing. So the one
// asks and the other counts, and of calls that come in one burst a few hundred too many get through. A call with one
// request counts when that is there: gRPC hands it through no earlier. Thread safe.
class CallLimits {
 public:
  explicit CallLimits(const server::LimitsConfig& config);

  // queue_full where `who` has as many open as one may; never for what a stop needs. `method` is
  // "/axisgate.v1.StageService/Move".
  Result<void> check(const std::string& who, std::string_view method) const;

  // For a grpc::ServerBuilder. This outlives the server that it builds.
  std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface> interceptor();

 private:
  class OpenCall;
  class Factory;
  using Kind = server::IdentityLimits::Kind;

  std::optional<Kind> kind_of(std::string_view method) const;  // none: without limit, and not counted

  std::set<std::string, std::less<>> streams_;  // does not change
  server::IdentityLimits limits_;
};

}  // namespace axisgate::rpc
