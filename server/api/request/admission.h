// Admission of callers: role, quota, and the context with which a device is asked. Every door asks here.
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
  // `access` and `lease_tokens` must outlive this object.
  Admission(const server::Access& access, const server::LimitsConfig& limits, const server::LeaseTokens& lease_tokens)
      : access_(access), lease_tokens_(lease_tokens), limits_(limits) {}

  // Identifies the caller, and checks role and quota. A door calls it before it reads anything of the request.
  // `as_called` is the door's name of the request, for messages. Fails with unauthenticated, not_allowed or queue_full.
  Result<server::Caller> let_in(RequestKind kind, const Credential& credential, std::string_view as_called) const;

  // A Place counts one open request or stream against the caller's quota until its last copy is destroyed. take_place()
  // returns null if the kind is not counted. `who` is the name from let_in(). The admission must outlive the place.
  using Place = server::IdentityLimits::Place;
  Place take_place(RequestKind kind, const std::string& who);

  // Returns the caller if their role allows the request. A token may have been revoked, or may have expired, since
  // let_in(). Fails with unauthenticated or not_allowed.
  Result<server::Caller> check_role(RequestKind kind, const Credential& credential) const;

  // Checks that the request_id has at most 128 characters, all printable ASCII. Fails with invalid_request.
  static Result<void> check_request_id(const Call& call);

  // Builds the context of a request by the deadline rule and the use of its kind. Fails with invalid_request if
  // check_request_id() fails, and with lease_lost if the lease token is invalid.
  Result<use::RequestContext> context_of(RequestKind kind, const Call& call, const server::Caller& caller) const;

  // Builds the context of a stop. Never refuses, not even a token that was revoked since let_in().
  use::RequestContext context_of_stop(const Call& call) const;

 private:
  Result<server::Caller> identify(const Credential& credential) const;
  Result<void> check_least_role(RequestKind kind, const server::Caller& caller, std::string_view as_called) const;

  const server::Access& access_;
  const server::LeaseTokens& lease_tokens_;
  server::IdentityLimits limits_;
};

// Fails with not_allowed if the configuration keeps the line for administrators and the caller is not one.
Result<void> check_line(const server::Access& access, const std::string& line, const server::Caller& caller);

}  // namespace axisgate::api
