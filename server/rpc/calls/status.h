// Problems as gRPC statuses: one table from reason to code, and the details that standard helpers decode.
#pragma once

#include <grpcpp/support/status.h>

#include <optional>

#include "device/core/problem.h"
#include "device/core/time.h"
#include "server/api/request/subscription.h"
#include "server/proto/problem.h"

namespace axisgate::rpc {

grpc::StatusCode code_of(Reason reason);

// When a request that was refused for this reason may be made again; nothing where waiting alone does not help.
std::optional<Duration> retry_after(Reason reason);

// Carries an ErrorStatus with Problem, ErrorInfo and, where waiting helps, RetryInfo as its error details, which gRPC
// sends as the trailing metadata `grpc-status-details-bin`.
grpc::Status to_status(const Problem& problem, const proto::Metadata& metadata = {});

// Of a stream: OK, or its problem, with the metadata "resume_revision" where it can be resumed.
grpc::Status to_status(const api::StreamEnd& end);

}  // namespace axisgate::rpc
