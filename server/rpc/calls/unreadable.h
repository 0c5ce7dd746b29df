// Requests that are not the message that their method takes.
#pragma once

#include <grpcpp/support/server_interceptor.h>

#include <memory>
#include <string_view>

#include "device/core/problem.h"

namespace axisgate::rpc {

// invalid_request.
Problem not_readable(std::string_view method);
Problem not_one_message(std::string_view method);

// For a grpc::ServerBuilder, before the interceptors that look at statuses: gives such a call its problem, where
// gRPC 1.51 says UNIMPLEMENTED and nothing else. Streams of requests are not ended by gRPC at all: incoming.h. Thread
// safe.
std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface> unreadable_interceptor();

}  // namespace axisgate::rpc
