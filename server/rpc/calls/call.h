// Conversion of a call's headers and context to the types of the API.
#pragma once

#include <grpcpp/server_context.h>

#include <optional>

#include "axisgate/v1/common.pb.h"
#include "server/api/request/call.h"
#include "server/front/call_filter.h"
#include "server/proto/digest.h"

namespace axisgate::rpc {

// Returns the call's token or, without one, the caller that the front identified by the connection.
api::Credential credential_of(const grpc::ServerContextBase& call);
// Returns the caller and their source as the front identified them by the connection.
front::Peer peer_of(const grpc::ServerContextBase& call);

// Builds the Call of a request from its `context`.
api::Call to_call(api::Credential credential, std::optional<TimePoint> deadline, const v1::CallContext& context);

// Builds the Call of a request; the first form is for requests without a context.
api::Call to_call(const grpc::CallbackServerContext& call);
api::Call to_call(const grpc::CallbackServerContext& call, const v1::CallContext& context, bool validate_only = false);

// Builds the Call of a request with a context.
template <class Request>
api::Call to_acting_call(const grpc::CallbackServerContext& context, const Request& request) {
  api::Call made = to_call(context, request.context());
  if (!made.request_id.empty()) made.digest = proto::digest_of(request);
  return made;
}

// Builds the Call of a request with a context and validate_only.
template <class Request>
api::Call to_checked_call(const grpc::CallbackServerContext& call, const Request& request) {
  api::Call made = to_call(call, request.context(), request.validate_only());
  if (!made.request_id.empty()) made.digest = proto::digest_of(request);
  return made;
}

}  // namespace axisgate::rpc
