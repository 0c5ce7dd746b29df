// Conversion of problems to gRPC statuses: one table from reason to code, and details that standard helpers decode.
#pragma once

#include <grpcpp/support/status.h>

#include <optional>

#include "device/core/problem.h"
#include "device/core/time.h"
#include "server/api/request/subscription.h"
#include "server/proto/problem.h"

namespace axisgate::rpc {

grpc::StatusCode code_of(Reason reason);

// Returns the delay after which a request refused for this reason may be repeated. nullopt if waiting does not help.
std::optional<Duration> retry_after(Reason reason);

// Puts an google.rpc.Status with Problem, ErrorInfo and, if waiting helps, RetryInfo into the error details. gRPC sends
// them as the trailing metadata `grpc-status-details-bin`.
grpc::Status to_status(const Problem& problem, const proto::Metadata& metadata = {});

// Returns OK or the stream's problem, with the metadata "resume_revision" if the stream can be resumed.
grpc::Status to_status(const api::StreamEnd& end);

}  // namespace axisgate::rpc
