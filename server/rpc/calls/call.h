// What comes with a call, as the api takes it.
#pragma once

#include <grpcpp/server_context.h>

#include <optional>

#include "axisgate/v1/common.pb.h"
#include "server/api/request/call.h"
#include "server/front/desk.h"
#include "server/proto/digest.h"

namespace axisgate::rpc {

// Of a call that was let in: its token, or whom the front knows by the connection.
api::Credential credential_of(const grpc::ServerContextBase& call);
// By the connection alone, as the front says: who, and from where.
front::Peer peer_of(const grpc::ServerContextBase& call);

// What `context` says, by this caller.
api::Call to_call(api::Credential credential, std::optional<TimePoint> deadline, const v1::CallContext& context);

// Of a question, which has no context of its own.
api::Call to_call(const grpc::CallbackServerContext& call);
api::Call to_call(const grpc::CallbackServerContext& call, const v1::CallContext& context, bool validate_only = false);

// Of a request with a context and validate_only.
template <class Request>
api::Call to_checked_call(const grpc::CallbackServerContext& call, const Request& request) {
  api::Call made = to_call(call, request.context(), request.validate_only());
  if (!made.request_id.empty()) made.digest = proto::digest_of(request);
  return made;
}

}  // namespace axisgate::rpc
