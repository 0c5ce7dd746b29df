// Callers, their roles, and the requests that the configuration keeps for administrators.
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

// Requests of operators that the configuration can keep for administrators.
enum class AdminKey { none, clear_errors, reset_device, take_over };

struct AdminCommand {
  std::string name;  // beginning of the command lines that are kept: "BEC:"
  AdminKey request = AdminKey::none;
};

struct AccessConfig {
  Role local = Role::operator_;            // of local callers who are not in `roles`; nobody: they need a token
  Role certificates = Role::operator_;     // of callers with a client certificate who are not in `roles`
  std::map<std::string, Role> roles = {};  // by the caller's name: "unix alice", "cert alice"
  std::vector<AdminCommand> admin_commands;
};

struct Caller {
  std::string who;  // as in Motion.who: "unix alice", "cert alice", "token night-scan", "tcp 127.0.0.1:39482"
  Role role = Role::nobody;
};

// Thread safe.
class Access {
 public:
  // `administrator` is the user as whom the daemon runs, such as "unix alice".
  Access(AccessConfig config, std::string administrator, std::unique_ptr<Tokens> tokens);

  // Returns a caller without a token: a local one, or one with a certificate.
  Caller without_token(std::string who) const;
  // Returns the caller with that token. Fails with unauthenticated.
  Result<Caller> by_token(std::string_view token, Calendar now) const;

  bool only_for_admins(AdminKey request) const;
  // `line` is a command line as the caller wrote it.
  bool only_for_admins(std::string_view line) const;

  Tokens& tokens() const { return *tokens_; }

 private:
  const AccessConfig config_;
  const std::string administrator_;
  const std::unique_ptr<Tokens> tokens_;
};

// Returns "token night-scan".
std::string token_caller(std::string_view name);
// Returns "cert alice".
std::string certificate_caller(std::string_view name);
// Returns "tcp 127.0.0.1:39482", a caller over loopback without any credential. Two calls with the same name may come
// from two people, and calls with two names from one person.
std::string anonymous_caller(std::string_view address);
bool is_anonymous(std::string_view who);
// Reports whether an anonymous caller's name is that of a connection.
bool names_connection(std::string_view who);
// Returns the name under which a caller's requests are remembered and take turns. All anonymous callers over loopback
// share one name.
std::string identity_of(std::string_view who);
// Returns the name under which a mill's queue counts a caller's jobs. All anonymous callers share one name.
std::string queued_as(std::string_view who);
// Name of all users of the Unix socket without a name of their own (connections/callers.h); anonymous, too.
inline constexpr std::string_view kSharedUnixName = "unix";
// Reports whether both are certainly the same caller; false for anonymous callers.
bool is_certainly(std::string_view who, std::string_view other);

}  // namespace axisgate::server
