// whoami, token create, list, revoke: identity of callers.
#include <fmt/format.h>
#include <google/protobuf/util/time_util.h>

#include <ctime>
#include <string>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

using google::protobuf::util::TimeUtil;

std::string role_name(v1::Role role) {
  switch (role) {
    case v1::ROLE_OBSERVER:
      return "observer";
    case v1::ROLE_OPERATOR:
      return "operator";
    case v1::ROLE_ADMIN:
      return "admin";
    default:
      return "nobody";
  }
}

v1::Role role_named(const std::string& name) {
  return name == "observer" ? v1::ROLE_OBSERVER : name == "admin" ? v1::ROLE_ADMIN : v1::ROLE_OPERATOR;
}

std::string token_text(const v1::Token& token) {
  const std::string begin = fmt::format("{}  {}  ", token.name(), role_name(token.role()));
  if (token.has_revoke_time()) return begin + "revoked " + time_text(token.revoke_time());
  const bool expired = TimeUtil::TimestampToTimeT(token.expire_time()) <= std::time(nullptr);
  return begin + (expired ? "expired " : "expires ") + time_text(token.expire_time());
}

}  // namespace

int who_am_i(const Session& session) {
  const v1::GetCallerResponse caller = session.connection.call(
      session.connection.access, &v1::AccessService::Stub::GetCaller, v1::GetCallerRequest(), kQuestionLimit);
  session.options.json ? print_json(caller) : print_line(fmt::format("{}, {}", caller.who(), role_name(caller.role())));
  return kDone;
}

int token_create(const Session& session) {
  v1::CreateTokenRequest request;
  *request.mutable_context() = session.connection.new_call_context();
  request.set_name(session.options.name);
  request.set_role(role_named(session.options.role));
  request.mutable_time_to_live()->set_seconds(std::int64_t{86'400} * session.options.days);
  const v1::CreateTokenResponse made = session.connection.call(
      session.connection.access, &v1::AccessService::Stub::CreateToken, request, kQuestionLimit);
  if (session.options.json) {
    print_json(made);
    return kDone;
  }
  print_note(fmt::format("{}. Save the token now: it cannot be shown again. To use it, set AXISGATE_TOKEN to it",
                         token_text(made.token())));
  print_line(made.secret());
  return kDone;
}

int token_list(const Session& session) {
  const v1::ListTokensResponse tokens = session.connection.call(
      session.connection.access, &v1::AccessService::Stub::ListTokens, v1::ListTokensRequest(), kQuestionLimit);
  if (session.options.json) {
    print_json(tokens);
    return kDone;
  }
  for (const v1::Token& token : tokens.tokens()) print_line(token_text(token));
  if (tokens.tokens().empty()) print_line("there are no tokens");
  return kDone;
}

int token_revoke(const Session& session) {
  v1::RevokeTokenRequest request;
  *request.mutable_context() = session.connection.new_call_context();
  request.set_name(session.options.name);
  session.connection.call(session.connection.access, &v1::AccessService::Stub::RevokeToken, request, kQuestionLimit);
  print_line(fmt::format("{} is revoked", session.options.name));
  return kDone;
}

}  // namespace axisgate::axisctl
