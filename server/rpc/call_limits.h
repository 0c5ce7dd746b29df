// How many calls each caller has open, counted where gRPC hands every call through.
#pragma once

#include <grpcpp/support/server_interceptor.h>

#include <memory>

#include "server/api/admission.h"

namespace axisgate::rpc {

// A gatekeeper refuses calls but does not see them end; an interceptor sees both ends but refuses nothing. So the one
// asks and the other counts, and of calls that come in one burst a few hundred too many get through. A call with one
// request counts when that is there: gRPC hands it through no earlier.
//
// For a grpc::ServerBuilder. `admission` outlives the server that it builds.
std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface> counting_interceptor(api::Admission& admission);

}  // namespace axisgate::rpc
