// Problems of requests whose message does not fit their method.
#pragma once

#include <grpcpp/support/server_interceptor.h>

#include <memory>
#include <string_view>

#include "device/core/problem.h"

namespace axisgate::rpc {

// Reason invalid_request.
Problem not_readable(std::string_view method);
Problem not_one_message(std::string_view method);

// Returns an interceptor for a grpc::ServerBuilder, to be added before the interceptors that look at statuses. It gives
// such a call its problem; gRPC 1.51 reports only UNIMPLEMENTED. gRPC does not end streams of requests at all:
// incoming.h. Thread safe.
std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface> unreadable_interceptor();

}  // namespace axisgate::rpc
