// Who calls, and tokens.
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
  // server::Tokens::kLifeMax at most; nothing: 90 days.
  std::optional<std::chrono::seconds> life{};
};

struct CreatedToken {
  std::string secret;  // nobody can read it a second time
  server::Token token;
};

// Thread safe.
class Tokens {
 public:
  // All outlive this, and `access` the gateway.
  Tokens(server::Gateway& gateway, const server::Access& access, const Admission& admission, Streams& streams);

  Result<server::Caller> caller(const Call& call) const;
  // Nothing: it was to be checked only. As server::Tokens::create().
  Result<std::optional<CreatedToken>> create(const Call& call, const Result<NewToken>& wanted) const;
  // Oldest first.
  Result<std::vector<server::Token>> list(const Call& call) const;
  // As server::Tokens::revoke(); after internal, the revocation holds and is written as soon as possible.
  Result<void> revoke(const Call& call, const std::string& name) const;

 private:
  // What the token's caller has open ends, and so do its leases.
  void cut_off(const std::string& token, const std::string& by) const;

  server::Gateway& gateway_;
  const server::Access& access_;
  const Admission& admission_;
  Streams& streams_;
  const std::shared_ptr<TokenRetry> retry_;
};

}  // namespace axisgate::api
