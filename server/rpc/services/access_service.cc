#include "server/rpc/services/access_service.h"

#include <chrono>
#include <vector>

#include "server/rpc/calls/call.h"
#include "server/rpc/calls/unary_call.h"

namespace axisgate::rpc {
namespace {

using server::Calendar;
using server::Role;
using server::Token;

static_assert(static_cast<int>(Role::observer) == v1::ROLE_OBSERVER);
static_assert(static_cast<int>(Role::admin) == v1::ROLE_ADMIN);

void fill(google::protobuf::Timestamp& time, Calendar from) { time.set_seconds(from.time_since_epoch().count()); }

v1::Token message_of(const Token& token) {
  v1::Token proto;
  proto.set_name(token.name);
  proto.set_role(static_cast<v1::Role>(token.role));
  fill(*proto.mutable_create_time(), token.created);
  fill(*proto.mutable_expire_time(), token.expires);
  if (token.revoked) fill(*proto.mutable_revoke_time(), *token.revoked);
  return proto;
}

Result<api::NewToken> to_new_token(const v1::CreateTokenRequest& request) {
  const bool known = request.role() >= v1::ROLE_UNSPECIFIED && request.role() <= v1::ROLE_ADMIN;
  if (!known) return fail(Reason::invalid_request, "there is no such role", "use observer, operator or admin");
  api::NewToken wanted{.name = request.name()};
  if (request.role() != v1::ROLE_UNSPECIFIED) wanted.role = static_cast<Role>(request.role());
  if (request.has_time_to_live()) wanted.life = std::chrono::seconds(request.time_to_live().seconds());
  return wanted;
}

}  // namespace

grpc::ServerUnaryReactor* AccessService::GetCaller(grpc::CallbackServerContext* context, const v1::GetCallerRequest*,
                                                   v1::GetCallerResponse* response) {
  return answer_at_once(response, tokens_.caller(to_call(*context)),
                        [](v1::GetCallerResponse& answer, const server::Caller& caller) {
                          answer.set_who(caller.who);
                          answer.set_role(static_cast<v1::Role>(caller.role));
                        });
}

grpc::ServerUnaryReactor* AccessService::CreateToken(grpc::CallbackServerContext* context,
                                                     const v1::CreateTokenRequest* request,
                                                     v1::CreateTokenResponse* response) {
  return answer_at_once(response, tokens_.create(to_checked_call(*context, *request), to_new_token(*request)),
                        [](v1::CreateTokenResponse& answer, const std::optional<api::CreatedToken>& created) {
                          if (!created) return;
                          answer.set_secret(created->secret);
                          *answer.mutable_token() = message_of(created->token);
                        });
}

grpc::ServerUnaryReactor* AccessService::ListTokens(grpc::CallbackServerContext* context, const v1::ListTokensRequest*,
                                                    v1::ListTokensResponse* response) {
  return answer_at_once(response, tokens_.list(to_call(*context)),
                        [](v1::ListTokensResponse& answer, const std::vector<Token>& tokens) {
                          for (const Token& token : tokens) *answer.add_tokens() = message_of(token);
                        });
}

grpc::ServerUnaryReactor* AccessService::RevokeToken(grpc::CallbackServerContext* context,
                                                     const v1::RevokeTokenRequest* request,
                                                     v1::RevokeTokenResponse* response) {
  const auto call = UnaryCall<v1::RevokeTokenResponse>::start(response);
  answering(call)(tokens_.revoke(to_call(*context), request->name()));
  return call.get();
}

}  // namespace axisgate::rpc
