#include "server/api/request/admission.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include "device/core/escape.h"
#include "device/link/clock.h"
#include "server/events/wall_time.h"
#include "server/limits.h"

namespace axisgate::api {
namespace {

using server::Caller;
using server::IdentityLimits;
using server::Role;
using use::RequestContext;

constexpr std::size_t kRequestIdMax = 128;

std::optional<IdentityLimits::Kind> counted_as(RequestKind kind) {
  switch (rule_of(kind).quota) {
    case Quota::none:
      return std::nullopt;
    case Quota::request:
      return IdentityLimits::Kind::call;
    case Quota::stream:
    case Quota::motion_stream:
    case Quota::path:
      break;
  }
  return IdentityLimits::Kind::stream;
}

TimePoint without_not_after(DeadlineRule rule, const Call& call) {
  if (rule == DeadlineRule::motion) return monotonic_now() + server::kMotionStartLimit;
  return call.deadline.value_or(monotonic_now() + server::kRequestLimit);
}

// Returns the time until which the request counts: the call's deadline at the latest.
TimePoint until(DeadlineRule rule, const Call& call) {
  const bool says_until = rule == DeadlineRule::change || rule == DeadlineRule::motion;
  const TimePoint end = says_until && call.not_after ? *call.not_after : without_not_after(rule, call);
  return std::min(end, call.deadline.value_or(TimePoint::max()));
}

}  // namespace

Result<Caller> Admission::identify(const Credential& credential) const {
  if (credential.token) return access_.by_token(*credential.token, server::calendar_now());
  if (!credential.needs_token) return access_.without_token(credential.who);
  return Caller{credential.who, Role::nobody};
}

Result<void> Admission::check_least_role(RequestKind kind, const Caller& caller, std::string_view as_called) const {
  if (caller.role == Role::nobody) {
    return fail(Reason::unauthenticated, fmt::format("{} needs a token here", caller.who),
                "set AXISGATE_TOKEN to one; an administrator makes one with `CreateToken`");
  }
  const Rule& rule = rule_of(kind);
  const Role least = access_.only_for_admins(rule.admin_key) ? Role::admin : rule.least_role;
  if (caller.role >= least) return {};
  return fail(Reason::not_allowed,
              fmt::format("{} asks for the role {}, and {} is {}", escaped(as_called), name(least), caller.who,
                          name(caller.role)),
              "call as the user as whom the daemon runs, over the Unix socket, or with a token of that role");
}

Result<Caller> Admission::let_in(RequestKind kind, const Credential& credential, std::string_view as_called) const {
  Result<Caller> caller = identify(credential);
  if (!caller) return caller;
  if (const auto allowed = check_least_role(kind, *caller, as_called); !allowed) return tl::unexpected(allowed.error());
  const auto counted = counted_as(kind);
  const Result<void> room = counted ? limits_.check(caller->who, *counted) : Result<void>();
  if (!room) return tl::unexpected(room.error());
  return caller;
}

Admission::Place Admission::take_place(RequestKind kind, const std::string& who) {
  const auto counted = counted_as(kind);
  return counted ? limits_.take(who, *counted) : nullptr;
}

Result<Caller> Admission::check_role(RequestKind kind, const Credential& credential) const {
  Result<Caller> caller = identify(credential);
  if (!caller) return caller;
  if (const auto allowed = check_least_role(kind, *caller, "this"); !allowed) return tl::unexpected(allowed.error());
  return caller;
}

Result<void> Admission::check_request_id(const Call& call) {
  const auto printable = [](char c) { return c >= ' ' && c <= '~'; };
  if (call.request_id.size() <= kRequestIdMax && std::ranges::all_of(call.request_id, printable)) return {};
  return fail(Reason::invalid_request,
              fmt::format("context.request_id is not at most {} printable ASCII characters", kRequestIdMax));
}

Result<RequestContext> Admission::context_of(RequestKind kind, const Call& call, const Caller& caller) const {
  const Rule& rule = rule_of(kind);
  if (rule.deadline == DeadlineRule::stop) return context_of_stop(call);
  RequestContext context{.who = caller.who,
                         .not_after = until(rule.deadline, call),
                         .role = std::string(name(caller.role)),
                         .identity = server::identity_of(caller.who),
                         .session = call.credential.session};
  if (rule.use != Use::nothing) {
    const auto lease = lease_tokens_.open(call.lease_token);
    // A request that uses axes is refused later, when the right is checked: a repeat must receive the result of the
    // first request, also if its lease has ended since, and Execute may carry a stop, which is never refused.
    if (!lease && rule.use == Use::lease) return tl::unexpected(lease.error());
    context.lease = lease.value_or(server::LeaseTokens::kUnknown);
  }
  if (rule.deadline == DeadlineRule::question) return context;
  if (const auto good = check_request_id(call); !good) return tl::unexpected(good.error());
  context.request_id = call.request_id;
  if (rule.use == Use::nothing || rule.use == Use::lease) return context;
  context.device_epoch = call.device_epoch;
  context.frame_epoch = call.frame_epoch;
  return context;
}

RequestContext Admission::context_of_stop(const Call& call) const {
  return {.who = name_of(call.credential),
          .request_id = escaped(call.request_id, kRequestIdMax),
          .not_after = until(DeadlineRule::stop, call),
          .lease = lease_tokens_.open(call.lease_token).value_or(0),
          .answer_by = call.deadline,
          .session = call.credential.session};
}

Result<void> check_line(const server::Access& access, const std::string& line, const Caller& caller) {
  if (caller.role == Role::admin || !access.only_for_admins(line)) return {};
  return tl::unexpected(Problem{.reason = Reason::not_allowed,
                                .message = fmt::format("only an administrator may send this command, and {} is {}",
                                                       caller.who, name(caller.role)),
                                .hint = "ask one, or leave it out of `admin_commands` in the configuration",
                                .sent = line});
}

}  // namespace axisgate::api
