#include "server/rpc/gatekeeper.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>
#include <vector>

#include "device/core/escape.h"
#include "server/access/access.h"
#include "server/rpc/method_kinds.h"
#include "server/rpc/status.h"

namespace axisgate::rpc {
namespace {

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
std::optional<std::string> token_in(const std::optional<std::string_view>& authorization) {
  if (!authorization) return std::nullopt;
  // The scheme's letter case does not count (RFC 9110, 11.1).
  const auto same = [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; };
  const bool bearer = std::ranges::equal(authorization->substr(0, kBearer.size()), kBearer, same);
  return std::string(bearer ? authorization->substr(kBearer.size()) : std::string_view{});
}

// "tcp 127.0.0.1:39482": gRPC says "ipv4:127.0.0.1:39482" or "ipv6:%5B::1%5D:39482".
std::string from_where(const grpc::CallbackServerContext& call) {
  const std::string peer = call.peer();
  const std::size_t colon = peer.find(':');
  return server::anonymous_caller(escaped(colon == std::string::npos ? peer : peer.substr(colon + 1)));
}

// Whom the connection named; none: nobody.
std::optional<std::string> named_user(const grpc::ServerContextBase& call) {
  const std::vector<grpc::string_ref> users = call.auth_context()->FindPropertyValues(kUser);
  if (users.empty()) return std::nullopt;
  return std::string(users.front().data(), users.front().size());
}

}  // namespace

api::Credential Gatekeeper::without_token(grpc::AuthContext& connection) {
  const std::optional<std::string> who = name_(connection);
  if (!who) return unnamed_;
  {
    // The context is the connection's, and has no lock of its own: with ours it changes once, before its first handler
    // reads it.
    const std::lock_guard lock(mutex_);
    if (connection.FindPropertyValues(kUser).empty()) connection.AddProperty(kUser, *who);
  }
  return {.who = *who};
}

grpc::Status Gatekeeper::Process(const InputMetadata& metadata, grpc::AuthContext* connection, OutputMetadata*,
                                 OutputMetadata*) {
  const grpc::Status answer = judge(metadata, *connection);
  if (!answer.ok()) gate_.metrics.count_refusal(answer.error_code());
  return answer;
}

grpc::Status Gatekeeper::judge(const InputMetadata& metadata, grpc::AuthContext& connection) {
  const std::optional<std::string> token = token_in(find(metadata, kAuthorization));
  const api::Credential credential = token ? api::Credential{.token = token} : without_token(connection);
  const std::string_view method = find(metadata, kMethod).value_or("");
  const Result<server::Caller> caller = gate_.admission.let_in(kind_of(method), credential, method);
  if (caller) return grpc::Status::OK;
  const Problem& problem = caller.error();
  return {code_of(problem.reason), fmt::format("{}; {}", problem.message, problem.hint)};
}

api::Credential credential_of(const grpc::CallbackServerContext& call) {
  if (auto token = token_in(find(call.client_metadata(), kAuthorization))) return {.token = std::move(token)};
  const std::optional<std::string> user = named_user(call);
  return {.who = user ? *user : from_where(call)};
}

std::string identity(const grpc::ServerContextBase& call) {
  const std::optional<std::string> token = token_in(find(call.client_metadata(), kAuthorization));
  return token ? api::name_of({.token = token}) : named_user(call).value_or(kAnonymous);
}

}  // namespace axisgate::rpc
