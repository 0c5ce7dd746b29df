// Bearer tokens: who may call with which role, and until when. Kept as hashes, so that reading the file does not let
// anybody call.
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

namespace axisgate::server {

using Calendar = std::chrono::sys_seconds;

struct Token {
  std::string name;  // unique among those that are good
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
  static constexpr auto kLifeMax = std::chrono::years(10);

  // Those of the file, which need not be there. internal, where it cannot be read or is none: the message says what and
  // in which line.
  static Result<std::unique_ptr<Tokens>> open(std::string path);

  // Whether such a token could be made. invalid_request for a name that is not a letter and then letters, digits, '-'
  // or
  // '_', or is that of a good token; out_of_range for a life beyond kLifeMax; queue_full.
  Result<void> check_new(const std::string& name, Calendar expires, Calendar now) const;

  // The token itself, which nobody can tell a second time: `axisgate.NAME.SECRET`. As check_new(); internal, where it
  // cannot be written: there is no such token then.
  Result<std::string> create(const std::string& name, Role role, Calendar expires, Calendar now);

  // not_found, where no good one has that name. internal, where it cannot be written: it is revoked all the same, until
  // the daemon ends or, once write_again() has succeeded, for good.
  Result<void> revoke(const std::string& name, Calendar now);

  // Writes what revoke() could not; false, where there is no such thing. internal, where it still cannot be written.
  Result<bool> write_again();

  // unauthenticated, where it is none of ours, has expired, or was revoked.
  Result<Token> check(std::string_view token, Calendar now) const;

  std::vector<Token> list() const;  // oldest first; those that are good no more are kept for 30 days

 private:
  explicit Tokens(std::string path) : path_(std::move(path)) {}
  Result<void> read();
  Result<void> write() const;
  Result<void> may_create(const std::string& name, Calendar expires, Calendar now) const;
  const Token* find_good(std::string_view name, Calendar now) const;

  const std::string path_;
  mutable std::mutex mutex_;
  std::vector<Token> tokens_;
  bool unwritten_ = false;  // whether revoke() has failed to write since write_again() last succeeded
};

// The NAME of `axisgate.NAME.SECRET`; empty where it is no such text.
std::string_view name_in(std::string_view token);

}  // namespace axisgate::server
