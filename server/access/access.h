// Who calls, and what that caller may ask for.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/problem.h"
#include "server/access/roles.h"
#include "server/access/tokens.h"

namespace axisgate::server {

// What an operator may ask for unless the configuration keeps it for administrators.
enum class KeptRequest { none, clear_errors, reset_device, take_over };

struct AdminCommand {
  std::string name;  // how the lines of callers begin that are kept: "BEC:"
  KeptRequest request = KeptRequest::none;
};

struct AccessConfig {
  Role local = Role::operator_;            // of local callers that `roles` does not name; nobody: they need a token
  Role certificates = Role::operator_;     // of callers with a client certificate that `roles` does not name
  std::map<std::string, Role> roles = {};  // by the caller's name, "unix alice", "cert alice"
  std::vector<AdminCommand> admin_commands;
};

struct Caller {
  std::string who;  // as in Motion.who: "unix alice", "cert alice", "token night-scan", "tcp 127.0.0.1:39482"
  Role role = Role::nobody;
};

// Thread safe.
class Access {
 public:
  // `administrator` is the user as whom the daemon runs, as "unix alice".
  Access(AccessConfig config, std::string administrator, std::unique_ptr<Tokens> tokens);

  // Somebody on this machine, or with a certificate; without a token.
  Caller without_token(std::string who) const;
  // unauthenticated.
  Result<Caller> by_token(std::string_view token, Calendar now) const;

  bool only_for_admins(KeptRequest request) const;
  // A line as a caller wrote it.
  bool only_for_admins(std::string_view line) const;

  Tokens& tokens() const { return *tokens_; }

 private:
  const AccessConfig config_;
  const std::string administrator_;
  const std::unique_ptr<Tokens> tokens_;
};

// "token night-scan"
std::string token_caller(std::string_view name);
// "cert alice"
std::string certificate_caller(std::string_view name);
// "tcp 127.0.0.1:39482": over loopback, without any credential. Two calls by one of these names may come from two
// people, and calls by two names from one.
std::string anonymous_caller(std::string_view address);
bool is_anonymous(std::string_view who);
// Of the anonymous, whether the name is that of one connection.
bool names_connection(std::string_view who);
// Under which name a caller's requests are remembered and take turns: all anonymous callers over loopback are one.
std::string identity_of(std::string_view who);
// Whose jobs the queue of a mill counts together: all callers without a name of their own are one.
std::string queued_as(std::string_view who);
// Of all users of the Unix socket beyond those that have a name of their own (connections/callers.h): anonymous, too.
inline constexpr std::string_view kSharedUnixName = "unix";
// Whether the two are one caller: false, where nobody can tell.
bool is_certainly(std::string_view who, std::string_view other);

}  // namespace axisgate::server
