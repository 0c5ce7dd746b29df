// A call that the front answers itself, counted and logged like a call that gRPC serves.
#pragma once

#include <string>

#include "server/api/request/call.h"
#include "server/api/request/subscription.h"
#include "server/front/call_filter.h"
#include "server/rpc/gate/refusals.h"
#include "server/rpc/gate/rpc_metrics.h"

namespace axisgate::rpc {

// A Served is open until one of the functions below ends it, and counts as CANCELLED without an end. Thread safe; only
// the first end counts.
class Served {
 public:
  // `metrics` and `refusals` must outlive this object.
  Served(RpcMetrics& metrics, Refusals& refusals, const front::Headers& headers, const front::Peer& peer);

  const std::string& method() const { return method_; }
  const api::Credential& credential() const { return credential_; }

  // End the call and return its reply: a message, the end of a stream, or a problem.
  front::Reply answered(std::string message);
  front::Reply ended(const api::StreamEnd& end);
  front::Reply refused(const Problem& problem) { return ended({.problem = problem}); }

 private:
  Refusals& refusals_;
  const front::Peer peer_;
  const std::string method_;
  const api::Credential credential_;
  RpcMetrics::Call call_;
};

// Return the call's path, and its token or, without one, the caller that the front identified by the connection.
std::string_view method_of(const front::Headers& headers);
api::Credential credential_of(const front::Headers& headers, const front::Peer& peer);

front::Reply to_reply(const grpc::Status& status);
front::Reply to_reply(const Problem& problem);

}  // namespace axisgate::rpc
