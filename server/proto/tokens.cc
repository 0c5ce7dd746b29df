#include "server/proto/tokens.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "server/events/wall_time.h"
#include "server/proto/pages.h"

namespace axisgate::proto {
namespace {

using server::Calendar;
using server::Role;
using server::Token;

static_assert(static_cast<int>(Role::observer) == v1::ROLE_OBSERVER);
static_assert(static_cast<int>(Role::admin) == v1::ROLE_ADMIN);

void fill(google::protobuf::Timestamp& time, Calendar from) { time.set_seconds(from.time_since_epoch().count()); }

}  // namespace

v1::Token to_proto(const Token& token) {
  v1::Token proto;
  proto.set_name(token.name);
  proto.set_role(static_cast<v1::Role>(token.role));
  fill(*proto.mutable_create_time(), token.created);
  fill(*proto.mutable_expire_time(), token.expires);
  if (token.revoked) fill(*proto.mutable_revoke_time(), *token.revoked);
  return proto;
}

void fill_page(const v1::ListTokensRequest& request, std::vector<Token> tokens, v1::ListTokensResponse& response) {
  if (request.valid_only()) {
    const Calendar now = server::calendar_now();
    std::erase_if(tokens, [&](const Token& token) { return !token.good(now); });
  }
  const auto key = [](const Token& token) {
    return fmt::format("{:020} {}", token.created.time_since_epoch().count(), token.name);
  };
  std::ranges::sort(tokens, {}, key);
  response.set_next_page_token(cut_page(tokens, request.page_size(), request.page_token(), key));
  for (const Token& token : tokens) *response.add_tokens() = to_proto(token);
}

Result<api::NewToken> to_new_token(const v1::CreateTokenRequest& request) {
  const bool known = request.role() >= v1::ROLE_UNSPECIFIED && request.role() <= v1::ROLE_ADMIN;
  if (!known) return fail(Reason::invalid_request, "there is no such role", "use observer, operator or admin");
  api::NewToken wanted{.name = request.name()};
  if (request.role() != v1::ROLE_UNSPECIFIED) wanted.role = static_cast<Role>(request.role());
  if (request.has_time_to_live()) wanted.life = std::chrono::seconds(request.time_to_live().seconds());
  return wanted;
}

}  // namespace axisgate::proto
