#include "server/rpc/access_service.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>

#include "server/events/wall_time.h"
#include "server/rpc/gatekeeper.h"
#include "server/rpc/unary_call.h"

namespace axisgate::rpc {
namespace {

using server::Calendar;
using server::Role;
using server::Token;

constexpr auto kLife = std::chrono::days(90);

static_assert(static_cast<int>(Role::observer) == api::ROLE_OBSERVER);
static_assert(static_cast<int>(Role::admin) == api::ROLE_ADMIN);

void fill(google::protobuf::Timestamp& time, Calendar from) { time.set_seconds(from.time_since_epoch().count()); }

api::Token message_of(const Token& token) {
  api::Token proto;
  proto.set_name(token.name);
  proto.set_role(static_cast<api::Role>(token.role));
  fill(*proto.mutable_create_time(), token.created);
  fill(*proto.mutable_expire_time(), token.expires);
  if (token.revoked) fill(*proto.mutable_revoke_time(), *token.revoked);
  return proto;
}

Result<Role> to_role(api::Role role) {
  if (role == api::ROLE_UNSPECIFIED) return Role::operator_;
  if (role < api::ROLE_OBSERVER || role > api::ROLE_ADMIN) {
    return fail(Reason::invalid_request, "there is no such role", "use observer, operator or admin");
  }
  return static_cast<Role>(role);
}

// Bounded before it is added to a time.
std::chrono::seconds life_of(const api::CreateTokenRequest& request) {
  if (!request.has_time_to_live()) return kLife;
  const std::chrono::seconds longest = server::Tokens::kLifeMax + std::chrono::seconds(1);
  return std::clamp(std::chrono::seconds(request.time_to_live().seconds()), std::chrono::seconds(0), longest);
}

}  // namespace

grpc::ServerUnaryReactor* AccessService::GetCaller(grpc::CallbackServerContext* context, const api::GetCallerRequest*,
                                                   api::GetCallerResponse* response) {
  const auto call = UnaryCall<api::GetCallerResponse>::start(response);
  const Result<server::Caller> caller = caller_with_role(*context, access_);
  if (!caller) return call->refuse(caller.error());
  call->answer([&](api::GetCallerResponse& answer) {
    answer.set_who(caller->who);
    answer.set_role(static_cast<api::Role>(caller->role));
  });
  return call.get();
}

grpc::ServerUnaryReactor* AccessService::CreateToken(grpc::CallbackServerContext* context,
                                                     const api::CreateTokenRequest* request,
                                                     api::CreateTokenResponse* response) {
  const auto call = UnaryCall<api::CreateTokenResponse>::start(response);
  const Result<Role> role = to_role(request->role());
  if (!role) return call->refuse(role.error());
  const Calendar begins = server::calendar_now(), ends = begins + life_of(*request);
  if (request->validate_only()) {
    const Result<void> checked = access_.tokens().check_new(request->name(), ends, begins);
    if (!checked) return call->refuse(checked.error());
    call->answer([](api::CreateTokenResponse&) {});
    return call.get();
  }
  const Result<std::string> secret = access_.tokens().create(request->name(), *role, ends, begins);
  if (!secret) return call->refuse(secret.error());
  spdlog::info("{} made the token {} ({})", caller(*context), request->name(), name(*role));
  call->answer([&](api::CreateTokenResponse& answer) {
    answer.set_secret(*secret);
    *answer.mutable_token() = message_of({request->name(), *role, begins, ends, {}, {}});
  });
  return call.get();
}

grpc::ServerUnaryReactor* AccessService::ListTokens(grpc::CallbackServerContext*, const api::ListTokensRequest*,
                                                    api::ListTokensResponse* response) {
  const auto call = UnaryCall<api::ListTokensResponse>::start(response);
  call->answer([&](api::ListTokensResponse& answer) {
    for (const Token& token : access_.tokens().list()) *answer.add_tokens() = message_of(token);
  });
  return call.get();
}

grpc::ServerUnaryReactor* AccessService::RevokeToken(grpc::CallbackServerContext* context,
                                                     const api::RevokeTokenRequest* request,
                                                     api::RevokeTokenResponse* response) {
  const auto call = UnaryCall<api::RevokeTokenResponse>::start(response);
  const Result<void> revoked = access_.tokens().revoke(request->name(), server::calendar_now());
  if (!revoked) return call->refuse(revoked.error());
  spdlog::info("{} revoked the token {}", caller(*context), request->name());
  call->answer([](api::RevokeTokenResponse&) {});
  return call.get();
}

}  // namespace axisgate::rpc
