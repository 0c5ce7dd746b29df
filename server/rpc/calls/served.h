// One call that the front answers itself, on record like those that gRPC serves: counted, and logged where it is
// refused.
#pragma once

#include <string>

#include "server/api/request/call.h"
#include "server/api/request/subscription.h"
#include "server/front/desk.h"
#include "server/rpc/gate/refusals.h"
#include "server/rpc/gate/rpc_metrics.h"

namespace axisgate::rpc {

// Open until its end is made; CANCELLED, if it goes without one. Thread safe; only one end is made.
class Served {
 public:
  // Both outlive it.
  Served(RpcMetrics& metrics, Refusals& refusals, const front::Headers& headers, const front::Peer& peer);

  const std::string& method() const { return method_; }
  const api::Credential& credential() const { return credential_; }

  // Its end: with the message of an answer, in order, or with a problem.
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

// Of the call with these headers: its path; its token, or whom the front knows by the connection.
std::string_view method_of(const front::Headers& headers);
api::Credential credential_of(const front::Headers& headers, const front::Peer& peer);

front::Reply to_reply(const grpc::Status& status);
front::Reply to_reply(const Problem& problem);

}  // namespace axisgate::rpc
