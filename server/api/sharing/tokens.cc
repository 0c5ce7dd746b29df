#include "server/api/sharing/tokens.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "server/api/request/audit.h"
#include "server/events/wall_time.h"
#include "server/limits.h"

namespace axisgate::api {
namespace {

using server::Calendar;

// Returns the life limited to just above the maximum, so that adding it to a time cannot overflow.
std::chrono::seconds life_of(const NewToken& wanted) {
  const std::chrono::seconds longest = server::kTokenLifeMax + std::chrono::seconds(1);
  return std::clamp(wanted.life.value_or(server::kTokenLife), std::chrono::seconds(0), longest);
}

// Returns an error although the token is refused from now on, because a restart of the daemon would accept it again.
Result<void> not_written(const std::string& token, const Problem& why) {
  return fail(
      Reason::internal,
      fmt::format("the token {} is revoked, but not on disk, so a restart would make it valid again: {}", token,
                  why.message),
      fmt::format("{}; the daemon tries again every few seconds, and its log says when it succeeded", why.hint));
}

}  // namespace

Tokens::Tokens(server::Gateway& gateway, const server::Access& access, const Admission& admission, Streams& streams)
    : gateway_(gateway),
      access_(access),
      admission_(admission),
      streams_(streams),
      retry_(TokenRetry::make(access.tokens(), [&gateway](Duration wait, std::function<void()> task) {
        gateway.timeouts().after(wait, std::move(task));
      })) {}

Result<server::Caller> Tokens::caller(const Call& call) const {
  return admission_.check_role(RequestKind::get_caller, call.credential);
}

Result<std::optional<CreatedToken>> Tokens::create(const Call& call, const Result<NewToken>& wanted) const {
  const auto caller = admission_.check_role(RequestKind::create_token, call.credential);
  if (!caller) return tl::unexpected(caller.error());
  if (!wanted) return tl::unexpected(wanted.error());
  const Calendar begins = server::calendar_now(), ends = begins + life_of(*wanted);
  if (call.validate_only) {
    const Result<void> checked = access_.tokens().check_new(wanted->name, ends, begins);
    if (!checked) return tl::unexpected(checked.error());
    return std::nullopt;
  }
  Result<std::string> secret = access_.tokens().create(wanted->name, wanted->role, ends, begins);
  if (!secret) return tl::unexpected(secret.error());
  audit(RequestKind::create_token, caller->who,
        fmt::format("made the token {} ({})", wanted->name, name(wanted->role)));
  return CreatedToken{*std::move(secret), {wanted->name, wanted->role, begins, ends, {}, {}}};
}

Result<std::vector<server::Token>> Tokens::list(const Call& call) const {
  const auto caller = admission_.check_role(RequestKind::list_tokens, call.credential);
  if (!caller) return tl::unexpected(caller.error());
  return access_.tokens().list();
}

void Tokens::cut_off(const std::string& token, const std::string& by) const {
  const std::string who = server::token_caller(token);
  streams_.cut_off(who, {.reason = Reason::unauthenticated,
                         .message = fmt::format("{} revoked the token {}", by, token),
                         .hint = "an administrator makes another one with `CreateToken`"});
  for (const auto& device : gateway_.devices()) {
    device->post([who, by](server::Leases& leases, TimePoint now) { leases.cut_off(who, by, now); });
  }
}

Result<void> Tokens::revoke(const Call& call, const std::string& name) const {
  const auto caller = admission_.check_role(RequestKind::revoke_token, call.credential);
  if (!caller) return tl::unexpected(caller.error());
  const Result<void> revoked = access_.tokens().revoke(name, server::calendar_now());
  const bool unwritten = !revoked && revoked.error().reason == Reason::internal;
  if (revoked || unwritten) audit(RequestKind::revoke_token, caller->who, fmt::format("revoked the token {}", name));
  if (revoked || unwritten) cut_off(name, caller->who);
  if (!unwritten) return revoked;
  retry_->start(revoked.error());
  return not_written(name, revoked.error());
}

}  // namespace axisgate::api
