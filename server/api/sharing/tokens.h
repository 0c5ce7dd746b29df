// Identity of the caller, and bearer tokens.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "device/core/problem.h"
#include "server/access/access.h"
#include "server/api/request/admission.h"
#include "server/api/request/call.h"
#include "server/api/request/streams.h"
#include "server/api/sharing/token_retry.h"
#include "server/gateway.h"

namespace axisgate::api {

struct NewToken {
  std::string name;
  server::Role role = server::Role::operator_;
  // At most server::kTokenLifeMax; nullopt: 90 days.
  std::optional<std::chrono::seconds> life{};
};

struct CreatedToken {
  std::string secret;  // cannot be read a second time
  server::Token token;
};

// Thread safe.
class Tokens {
 public:
  // The referenced objects must outlive this one; `access` must also outlive the gateway.
  Tokens(server::Gateway& gateway, const server::Access& access, const Admission& admission, Streams& streams);

  Result<server::Caller> caller(const Call& call) const;
  // Creates a token as server::Tokens::create() does. Returns nullopt after a check with validate_only.
  Result<std::optional<CreatedToken>> create(const Call& call, const Result<NewToken>& wanted) const;
  // Returns the oldest token first.
  Result<std::vector<server::Token>> list(const Call& call) const;
  // Revokes a token as server::Tokens::revoke() does. After internal, the token is revoked, and the revocation is
  // written as soon as possible.
  Result<void> revoke(const Call& call, const std::string& name) const;

 private:
  // Ends all streams and leases of the token's caller.
  void cut_off(const std::string& token, const std::string& by) const;

  server::Gateway& gateway_;
  const server::Access& access_;
  const Admission& admission_;
  Streams& streams_;
  const std::shared_ptr<TokenRetry> retry_;
};

}  // namespace axisgate::api
