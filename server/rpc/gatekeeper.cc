#include "server/rpc/gatekeeper.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>
#include <vector>

#include "device/core/escape.h"
#include "server/access/tokens.h"
#include "server/events/wall_time.h"
#include "server/rpc/method_roles.h"

namespace axisgate::rpc {
namespace {

using server::Caller;
using server::Role;

constexpr const char* kUser = "axisgate_user";
constexpr const char* kAuthorization = "authorization";
constexpr const char* kMethod = ":path";
constexpr std::string_view kBearer = "bearer ";

template <class Metadata>
std::optional<std::string_view> find(const Metadata& metadata, const char* key) {
  const auto found = metadata.find(key);
  if (found == metadata.end()) return std::nullopt;
  return std::string_view(found->second.data(), found->second.size());
}

// The token in `authorization`; empty text where that is something else.
std::optional<std::string_view> token_in(const std::optional<std::string_view>& authorization) {
  if (!authorization) return std::nullopt;
  // The scheme's letter case does not count (RFC 9110, 11.1).
  const auto same = [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; };
  const bool bearer = std::ranges::equal(authorization->substr(0, kBearer.size()), kBearer, same);
  return bearer ? authorization->substr(kBearer.size()) : std::string_view{};
}

// "tcp 127.0.0.1:39482": gRPC says "ipv4:127.0.0.1:39482" or "ipv6:%5B::1%5D:39482".
std::string from_where(const grpc::CallbackServerContext& call) {
  const std::string peer = call.peer();
  const std::size_t colon = peer.find(':');
  return "tcp " + escaped(colon == std::string::npos ? peer : peer.substr(colon + 1));
}

// Whom the connection told of; none: nobody.
std::optional<std::string> named_user(const grpc::ServerContextBase& call) {
  const std::vector<grpc::string_ref> users = call.auth_context()->FindPropertyValues(kUser);
  if (users.empty()) return std::nullopt;
  return std::string(users.front().data(), users.front().size());
}

std::string user_of(const grpc::CallbackServerContext& call) {
  const std::optional<std::string> user = named_user(call);
  return user ? *user : from_where(call);
}

grpc::Status refuse(grpc::StatusCode code, const std::string& message, const std::string& hint) {
  return {code, fmt::format("{}; {}", message, hint)};
}

}  // namespace

Caller Gatekeeper::without_token(grpc::AuthContext& connection) {
  const std::optional<std::string> who = name_(connection);
  if (!who) return unnamed_;
  {
    // The context is the connection's, and has no lock of its own: with ours it changes once, before its first handler
    // reads it.
    const std::lock_guard lock(mutex_);
    if (connection.FindPropertyValues(kUser).empty()) connection.AddProperty(kUser, *who);
  }
  return gate_.access.without_token(*who);
}

grpc::Status Gatekeeper::Process(const InputMetadata& metadata, grpc::AuthContext* connection, OutputMetadata*,
                                 OutputMetadata*) {
  const grpc::Status answer = judge(metadata, *connection);
  if (!answer.ok()) gate_.metrics.count_refusal(answer.error_code());
  return answer;
}

grpc::Status Gatekeeper::judge(const InputMetadata& metadata, grpc::AuthContext& connection) {
  const std::optional<std::string_view> token = token_in(find(metadata, kAuthorization));
  const Result<Caller> caller =
      token ? gate_.access.by_token(*token, server::calendar_now()) : without_token(connection);
  if (!caller) return refuse(grpc::StatusCode::UNAUTHENTICATED, caller.error().message, caller.error().hint);
  if (caller->role == Role::nobody) {
    return refuse(grpc::StatusCode::UNAUTHENTICATED, fmt::format("{} needs a token here", caller->who),
                  "put one into AXISGATE_TOKEN; an administrator makes one with `axisctl token create`");
  }
  const std::string_view method = find(metadata, kMethod).value_or("");
  const Role needed = role_for(method, gate_.access);
  if (caller->role < needed) {
    return refuse(grpc::StatusCode::PERMISSION_DENIED,
                  fmt::format("{} asks for the role {}, and {} is {}", escaped(method), name(needed), caller->who,
                              name(caller->role)),
                  "call as the user as whom the daemon runs, over the Unix socket, or with a token of that role");
  }
  const Result<void> room = gate_.limits.check(caller->who, method);
  if (!room) return refuse(grpc::StatusCode::RESOURCE_EXHAUSTED, room.error().message, room.error().hint);
  return grpc::Status::OK;
}

std::string caller(const grpc::CallbackServerContext& call) {
  const auto token = token_in(find(call.client_metadata(), kAuthorization));
  return token ? server::token_caller(server::name_in(*token)) : user_of(call);
}

std::string identity(const grpc::ServerContextBase& call) {
  const auto token = token_in(find(call.client_metadata(), kAuthorization));
  return token ? server::token_caller(server::name_in(*token)) : named_user(call).value_or(kNameless);
}

Result<std::string> role_of(const grpc::CallbackServerContext& call, const server::Access& access) {
  const Result<Caller> known = caller_with_role(call, access);
  if (!known) return tl::unexpected(known.error());
  return std::string(name(known->role));
}

Result<Caller> caller_with_role(const grpc::CallbackServerContext& call, const server::Access& access) {
  const auto token = token_in(find(call.client_metadata(), kAuthorization));
  return token ? access.by_token(*token, server::calendar_now()) : access.without_token(user_of(call));
}

Result<void> check_command_role(const std::string& line, const server::Caller& caller, const server::Access& access) {
  if (caller.role == Role::admin || !access.only_for_admins(line)) return {};
  Problem problem{.reason = Reason::not_allowed,
                  .message = fmt::format("only an administrator may send this command, and {} is {}", caller.who,
                                         name(caller.role)),
                  .hint = "ask one, or leave it out of `admin_commands` in the configuration",
                  .sent = line};
  return tl::unexpected(std::move(problem));
}

}  // namespace axisgate::rpc
