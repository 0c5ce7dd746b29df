// Bearer tokens: their names, roles and expiry. Only hashes are stored, so that reading the file lets nobody call.
#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/problem.h"
#include "server/access/roles.h"
#include "server/limits.h"

namespace axisgate::server {

using Calendar = std::chrono::sys_seconds;

struct Token {
  std::string name;  // unique among valid tokens
  Role role = Role::nobody;
  Calendar created{}, expires{};
  std::optional<Calendar> revoked;
  std::string hash;  // SHA-256 of the whole token, 64 hexadecimal digits

  bool good(Calendar now) const { return !revoked && now < expires; }
};

// Thread safe.
class Tokens {
 public:
  static constexpr std::size_t kNameMax = 32, kKept = 1000;

  // Reads the tokens from the file, which may be missing. Fails with internal if the file cannot be read or is invalid;
  // the message says why, and in which line.
  static Result<std::unique_ptr<Tokens>> open(std::string path);

  // Checks that such a token could be created. Fails with invalid_request if the name is not a letter followed by
  // letters, digits, '-' or '_', or if a valid token has it; with out_of_range for a validity below 1 s or beyond
  // kTokenLifeMax; and with queue_full.
  Result<void> check_new(const std::string& name, Calendar expires, Calendar now) const;

  // Returns the token itself, which cannot be read again: `axisgate.NAME.SECRET`. Fails as check_new() does, and with
  // internal if it cannot be written; the token does not exist then.
  Result<std::string> create(const std::string& name, Role role, Calendar expires, Calendar now);

  // Fails with not_found if no valid token has that name, and with internal if the revocation cannot be written. In
  // this case the token is revoked until the daemon ends, or for good once write_again() has succeeded.
  Result<void> revoke(const std::string& name, Calendar now);

  // Writes revocations that revoke() could not write. Returns false if there are none. Fails with internal if they
  // still cannot be written.
  Result<bool> write_again();

  // Returns the token. Fails with unauthenticated if it is not a token of this daemon, has expired, or was revoked.
  Result<Token> check(std::string_view token, Calendar now) const;

  std::vector<Token> list() const;  // oldest first; tokens that are no longer valid are kept for 30 days

 private:
  explicit Tokens(std::string path) : path_(std::move(path)) {}
  Result<void> read();
  Result<void> write() const;
  Result<void> may_create(const std::string& name, Calendar expires, Calendar now) const;
  const Token* find_good(std::string_view name, Calendar now) const;

  const std::string path_;
  mutable std::mutex mutex_;
  std::vector<Token> tokens_;
  bool unwritten_ = false;  // revoke() has failed to write since write_again() last succeeded
};

// Returns the NAME of `axisgate.NAME.SECRET`; empty if the text has another form.
std::string_view name_in(std::string_view token);

}  // namespace axisgate::server
