// whoami, token create, list, revoke: identity of callers.
#include <fmt/format.h>
#include <google/protobuf/util/time_util.h>

#include <CLI/CLI.hpp>
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

int who_am_i(const Session& session) {
  const v1::GetCallerResponse caller = session.connection.call(
      session.connection.access, &v1::AccessService::Stub::GetCaller, v1::GetCallerRequest(), kQuestionLimit);
  session.options.json ? print_json(caller)
                       : print_line(fmt::format("{}, {}", caller.caller().name(), role_name(caller.role())));
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
  constexpr int all_that_the_daemon_keeps = 1000;
  v1::ListTokensRequest request;
  request.set_page_size(all_that_the_daemon_keeps);
  const v1::ListTokensResponse tokens =
      session.connection.call(session.connection.access, &v1::AccessService::Stub::ListTokens, request, kQuestionLimit);
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
  request.set_token(session.options.name);
  session.connection.call(session.connection.access, &v1::AccessService::Stub::RevokeToken, request, kQuestionLimit);
  print_line(fmt::format("{} is revoked", session.options.name));
  return kDone;
}

void token_create_options(CLI::App& verb, Options& options) {
  verb.add_option("NAME", options.name, "the name: NAME calls as 'token NAME'")->required()->type_name("");
  verb.add_option("--role", options.role, "what a caller with this token may do")
      ->check(CLI::IsMember({"observer", "operator", "admin"}))
      ->capture_default_str();
  verb.add_option("--days", options.days, "days until it expires")
      ->check(CLI::Range(1, 3650))
      ->capture_default_str()
      ->type_name("DAYS");
}

void token_revoke_options(CLI::App& verb, Options& options) {
  verb.add_option("NAME", options.name, "as `token list` shows it")->required()->type_name("");
}

constexpr Verb kTokenVerbs[] = {
    {.words = "whoami",
     .heading = Heading::looking,
     .description = "show your name and role, as the daemon identifies you",
     .examples = "axisctl whoami",
     .run = who_am_i},
    {.words = "token",
     .heading = Heading::stopping,
     .description = "for administrators: access tokens: create, list, revoke",
     .examples = "axisctl token create night-scan --days 30\naxisctl token list\naxisctl token revoke night-scan"},
    {.words = "token create",
     .description = "create a token and print it; to use it, set AXISGATE_TOKEN to it",
     .add_options = token_create_options,
     .run = token_create},
    {.words = "token list", .description = "show the tokens, with role and expiry", .run = token_list},
    {.words = "token revoke",
     .description = "refuse all further calls with this token",
     .add_options = token_revoke_options,
     .run = token_revoke},
};

}  // namespace

std::span<const Verb> token_verbs() { return kTokenVerbs; }

}  // namespace axisgate::axisctl
