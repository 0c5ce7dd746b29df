#include "server/rpc/calls/served.h"

#include <utility>

#include "server/rpc/calls/bearer.h"
#include "server/rpc/calls/session.h"
#include "server/rpc/calls/status.h"

namespace axisgate::rpc {

std::string_view method_of(const front::Headers& headers) { return find(headers, ":path").value_or(""); }

api::Credential credential_of(const front::Headers& headers, const front::Peer& peer) {
  std::string session = session_in(find(headers, kSessionHeader), peer.who);
  if (auto token = token_in(find(headers, "authorization"))) {
    return {.token = std::move(token), .session = std::move(session)};
  }
  return {.who = peer.who, .needs_token = peer.needs_token, .session = std::move(session)};
}

front::Reply to_reply(const grpc::Status& status) {
  return {.code = status.error_code(), .message = status.error_message(), .details = status.error_details()};
}

front::Reply to_reply(const Problem& problem) {
  front::Reply reply = to_reply(to_status(problem));
  reply.retry_after = retry_after(problem.reason);
  return reply;
}

Served::Served(RpcMetrics& metrics, Refusals& refusals, const front::Headers& headers, const front::Peer& peer)
    : refusals_(refusals),
      peer_(peer),
      method_(method_of(headers)),
      credential_(credential_of(headers, peer)),
      call_(metrics, method_) {}

front::Reply Served::answered(std::string message) {
  front::Reply reply = ended({});
  reply.body = std::move(message);
  return reply;
}

front::Reply Served::ended(const api::StreamEnd& end) {
  const grpc::Status status = to_status(end);
  call_.ended(status.error_code());
  if (end.problem) refusals_.note(peer_, credential_, method_, end.problem->reason, end.problem->message);
  front::Reply reply = to_reply(status);
  if (end.problem) reply.retry_after = retry_after(end.problem->reason);
  return reply;
}

}  // namespace axisgate::rpc
