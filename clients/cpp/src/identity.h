// The metadata by which the daemon identifies the caller and the program.
#pragma once

#include <grpcpp/support/client_interceptor.h>

#include <memory>
#include <string>
#include <vector>

namespace axisgate::client {

using Interceptors = std::vector<std::unique_ptr<grpc::experimental::ClientInterceptorFactoryInterface>>;

// Returns the interceptors that identify the caller, by `token` unless it is empty, and the program: the daemon treats
// all connections of this process as one program.
Interceptors identifying(const std::string& token);

// Returns a random UUID.
std::string new_uuid();

}  // namespace axisgate::client
