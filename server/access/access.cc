#include "server/access/access.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <utility>

namespace axisgate::server {
namespace {

constexpr std::string_view kCertificate = "cert ", kAnonymous = "tcp ";

// Removes blanks and converts to upper case, because the command table ignores both blanks and letter case.
std::string plain(std::string_view line) {
  std::string text;
  for (const char c : line) {
    if (c != ' ' && c != '\t') text += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  return text;
}

}  // namespace

Access::Access(AccessConfig config, std::string administrator, std::unique_ptr<Tokens> tokens)
    : config_(std::move(config)), administrator_(std::move(administrator)), tokens_(std::move(tokens)) {}

Caller Access::without_token(std::string who) const {
  if (who == administrator_) return {std::move(who), Role::admin};
  if (const auto named = config_.roles.find(who); named != config_.roles.end()) return {std::move(who), named->second};
  const Role role = who.starts_with(kCertificate) ? config_.certificates : config_.local;
  return {std::move(who), role};
}

Result<Caller> Access::by_token(std::string_view token, Calendar now) const {
  const Result<Token> known = tokens_->check(token, now);
  if (!known) return tl::unexpected(known.error());
  return Caller{token_caller(known->name), known->role};
}

bool Access::only_for_admins(AdminKey request) const {
  if (request == AdminKey::none) return false;
  return std::ranges::find(config_.admin_commands, request, &AdminCommand::request) != config_.admin_commands.end();
}

bool Access::only_for_admins(std::string_view line) const {
  const std::string text = plain(line);
  return std::ranges::any_of(config_.admin_commands,
                             [&](const AdminCommand& one) { return text.starts_with(plain(one.name)); });
}

std::string token_caller(std::string_view name) { return fmt::format("token {}", name); }
std::string certificate_caller(std::string_view name) { return fmt::format("{}{}", kCertificate, name); }
std::string anonymous_caller(std::string_view address) { return fmt::format("{}{}", kAnonymous, address); }
bool names_connection(std::string_view who) { return who.starts_with(kAnonymous); }
bool is_anonymous(std::string_view who) { return names_connection(who) || who == kSharedUnixName; }
std::string identity_of(std::string_view who) {
  return std::string(names_connection(who) ? kAnonymous.substr(0, kAnonymous.find(' ')) : who);
}
std::string queued_as(std::string_view who) { return is_anonymous(who) ? "callers without a name" : std::string(who); }
bool is_certainly(std::string_view who, std::string_view other) { return who == other && !is_anonymous(who); }

}  // namespace axisgate::server
