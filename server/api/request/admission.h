// Who is let in with what: role, quota, and the context with which a device is asked. Every door asks here.
#pragma once

#include <string>
#include <string_view>

#include "device/core/problem.h"
#include "device/stage/requests.h"
#include "server/access/access.h"
#include "server/access/identity_limits.h"
#include "server/access/lease_tokens.h"
#include "server/api/request/call.h"
#include "server/api/request/request_kinds.h"

namespace axisgate::api {

// Thread safe.
class Admission {
 public:
  // `access` and `lease_tokens` outlive this.
  Admission(const server::Access& access, const server::LimitsConfig& limits, const server::LeaseTokens& lease_tokens)
      : access_(access), lease_tokens_(lease_tokens), limits_(limits) {}

  // First of all for a door, before anything of the request is read. `as_called` is what the door calls the request,
  // for people. unauthenticated, not_allowed, queue_full.
  Result<server::Caller> let_in(RequestKind kind, const Credential& credential, std::string_view as_called) const;

  // One that is open; gives its place back when the last copy is gone. Null where the kind is not counted. `who` is as
  // let_in() knew the caller. The admission outlives it.
  using Place = server::IdentityLimits::Place;
  Place take_place(RequestKind kind, const std::string& who);

  // The caller, where one of that role may ask this. A token may have been revoked, or have expired, since let_in().
  // unauthenticated, not_allowed.
  Result<server::Caller> check_role(RequestKind kind, const Credential& credential) const;

  // Of at most 128 printable ASCII characters. invalid_request.
  static Result<void> check_request_id(const Call& call);

  // As the kind's patience and use have it. invalid_request for a request_id of more than 128 characters, or others
  // than printable ASCII; lease_lost for what is no token of a lease.
  Result<stage::RequestContext> context_of(RequestKind kind, const Call& call, const server::Caller& caller) const;

  // Of a stop, which nothing in its context refuses: not even a token that was revoked since let_in().
  stage::RequestContext context_of_stop(const Call& call) const;

 private:
  Result<server::Caller> identify(const Credential& credential) const;
  Result<void> check_least_role(RequestKind kind, const server::Caller& caller, std::string_view as_called) const;

  const server::Access& access_;
  const server::LeaseTokens& lease_tokens_;
  server::IdentityLimits limits_;
};

// not_allowed where the line is one that the configuration keeps for administrators.
Result<void> check_line(const server::Access& access, const std::string& line, const server::Caller& caller);

}  // namespace axisgate::api
