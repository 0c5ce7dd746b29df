// The caller's token on every call of a channel.
#pragma once

#include <grpcpp/support/client_interceptor.h>

#include <memory>
#include <string>
#include <vector>

namespace axisgate::axisctl {

// The variable that holds the token by which the daemon identifies the caller; unset: by the caller's user.
inline constexpr const char* kTokenVariable = "AXISGATE_TOKEN";

using Interceptors = std::vector<std::unique_ptr<grpc::experimental::ClientInterceptorFactoryInterface>>;

// For a channel; none without a token.
Interceptors with_bearer(const std::string& token);

}  // namespace axisgate::axisctl
