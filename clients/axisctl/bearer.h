// gRPC interceptors that add the caller's token to every call of a channel.
#pragma once

#include <grpcpp/support/client_interceptor.h>

#include <memory>
#include <string>
#include <vector>

namespace axisgate::axisctl {

// Environment variable with the token by which the daemon identifies the caller. Unset: the daemon identifies the
// caller by their user.
inline constexpr const char* kTokenVariable = "AXISGATE_TOKEN";

using Interceptors = std::vector<std::unique_ptr<grpc::experimental::ClientInterceptorFactoryInterface>>;

// Returns the interceptors for a channel; none if the token is empty.
Interceptors with_bearer(const std::string& token);

}  // namespace axisgate::axisctl
