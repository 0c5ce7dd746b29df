#include "server/access/tokens.h"

#include <fmt/format.h>
#include <openssl/evp.h>
#include <openssl/rand.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <utility>

#include "server/access/synced_file.h"
#include "server/limits.h"

namespace axisgate::server {
namespace {

constexpr std::string_view kPrefix = "axisgate.";
constexpr std::string_view kHeader = "# axisgate tokens 1: name role created expires revoked sha256\n";
constexpr std::size_t kSecretBytes = 32;

std::string hexadecimal(const unsigned char* bytes, std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) text += fmt::format("{:02x}", bytes[i]);
  return text;
}

std::string hash_of(std::string_view token) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int length = 0;
  EVP_Digest(token.data(), token.size(), digest.data(), &length, EVP_sha256(), nullptr);
  return hexadecimal(digest.data(), length);
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

bool is_name(std::string_view name) {
  return !name.empty() && name.size() <= Tokens::kNameMax && is_letter(name.front()) &&
         std::ranges::all_of(name,
                             [](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '-' || c == '_'; });
}

std::string to_line(const Token& token) {
  const auto seconds = [](Calendar time) { return time.time_since_epoch().count(); };
  return fmt::format("{} {} {} {} {} {}\n", token.name, name(token.role), seconds(token.created),
                     seconds(token.expires), token.revoked ? seconds(*token.revoked) : 0, token.hash);
}

std::optional<Token> from_line(const std::string& line) {
  std::istringstream fields(line);
  Token token;
  std::string role, rest;
  std::int64_t created = 0, expires = 0, revoked = 0;
  fields >> token.name >> role >> created >> expires >> revoked >> token.hash;
  const bool whole = fields && !(fields >> rest);
  const std::optional<Role> known = role_named(role);
  if (!whole || !known || !is_name(token.name) || token.hash.size() != 64) return std::nullopt;
  token.role = *known;
  token.created = Calendar(std::chrono::seconds(created));
  token.expires = Calendar(std::chrono::seconds(expires));
  if (revoked != 0) token.revoked = Calendar(std::chrono::seconds(revoked));
  return token;
}

bool worth_keeping(const Token& token, Calendar now) {
  return now - token.revoked.value_or(token.expires) <= kTokenForgottenAfter;
}

}  // namespace

Result<std::unique_ptr<Tokens>> Tokens::open(std::string path) {
  std::unique_ptr<Tokens> tokens(new Tokens(std::move(path)));
  if (const Result<void> read = tokens->read(); !read) return tl::unexpected(read.error());
  return tokens;
}

Result<void> Tokens::read() {
  const Result<std::string> text = read_state_file(path_);
  if (!text) return tl::unexpected(text.error());
  std::istringstream file(*text);
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    if (line.empty() || line.front() == '#') continue;
    std::optional<Token> token = from_line(line);
    if (!token) {
      return fail(Reason::internal, fmt::format("{}:{}: is no token", path_, number),
                  "remove the line; `axisctl token create` makes another token");
    }
    tokens_.push_back(*std::move(token));
  }
  return {};
}

Result<void> Tokens::write() const {
  std::string text(kHeader);
  for (const Token& token : tokens_) text += to_line(token);
  return replace_synced(path_, text);
}

const Token* Tokens::find_good(std::string_view name, Calendar now) const {
  const auto found =
      std::ranges::find_if(tokens_, [&](const Token& token) { return token.name == name && token.good(now); });
  return found == tokens_.end() ? nullptr : &*found;
}

Result<void> Tokens::may_create(const std::string& name, Calendar expires, Calendar now) const {
  if (!is_name(name)) {
    return fail(Reason::invalid_request, "that is not a name for a token",
                fmt::format("use a letter, then letters, digits, '-' or '_', at most {} in all", kNameMax));
  }
  if (find_good(name, now)) {
    return fail(Reason::invalid_request, fmt::format("there is a token named \"{}\" already", name),
                "revoke it first, or choose another name");
  }
  if (expires <= now || expires > now + kTokenLifeMax) {
    return fail(Reason::out_of_range, "a token lives for at least a second and at most ten years");
  }
  const auto kept = std::ranges::count_if(tokens_, [now](const Token& token) { return worth_keeping(token, now); });
  if (kept < static_cast<std::ptrdiff_t>(kKept)) return {};
  return fail(Reason::queue_full, fmt::format("there are {} tokens already", kKept), "revoke those nobody uses");
}

Result<void> Tokens::check_new(const std::string& name, Calendar expires, Calendar now) const {
  const std::lock_guard lock(mutex_);
  return may_create(name, expires, now);
}

Result<std::string> Tokens::create(const std::string& name, Role role, Calendar expires, Calendar now) {
  const std::lock_guard lock(mutex_);
  if (const Result<void> allowed = may_create(name, expires, now); !allowed) return tl::unexpected(allowed.error());
  std::array<unsigned char, kSecretBytes> secret{};
  if (RAND_bytes(secret.data(), static_cast<int>(secret.size())) != 1) {
    return fail(Reason::internal, "the system gives no random numbers");
  }
  const std::string token = fmt::format("{}{}.{}", kPrefix, name, hexadecimal(secret.data(), secret.size()));
  std::erase_if(tokens_, [now](const Token& old) { return !worth_keeping(old, now); });
  tokens_.push_back({name, role, now, expires, {}, hash_of(token)});
  if (const Result<void> written = write(); !written) {
    tokens_.pop_back();
    return tl::unexpected(written.error());
  }
  return token;
}

Result<void> Tokens::revoke(const std::string& name, Calendar now) {
  const std::lock_guard lock(mutex_);
  const auto token = std::ranges::find_if(tokens_, [&](const Token& one) { return one.name == name && one.good(now); });
  if (token == tokens_.end()) {
    return fail(Reason::not_found, "no good token has that name", "`ListTokens` shows those there are");
  }
  token->revoked = now;
  const Result<void> written = write();
  unwritten_ = unwritten_ || !written;
  return written;
}

Result<bool> Tokens::write_again() {
  const std::lock_guard lock(mutex_);
  if (!unwritten_) return false;
  if (const Result<void> written = write(); !written) return tl::unexpected(written.error());
  unwritten_ = false;
  return true;
}

Result<Token> Tokens::check(std::string_view token, Calendar now) const {
  const std::string hash = hash_of(token);
  const std::lock_guard lock(mutex_);
  const auto found = std::ranges::find(tokens_, hash, &Token::hash);
  if (found == tokens_.end()) {
    return fail(Reason::unauthenticated, "that token is not one of this daemon's",
                "is it whole? an administrator makes one with `CreateToken`");
  }
  if (found->good(now)) return *found;
  return fail(Reason::unauthenticated,
              fmt::format("the token \"{}\" {}", found->name, found->revoked ? "was revoked" : "has expired"),
              "an administrator makes another with `CreateToken`");
}

std::vector<Token> Tokens::list() const {
  const std::lock_guard lock(mutex_);
  return tokens_;
}

std::string_view name_in(std::string_view token) {
  if (!token.starts_with(kPrefix)) return {};
  token.remove_prefix(kPrefix.size());
  const std::string_view name = token.substr(0, token.find('.'));
  return is_name(name) ? name : std::string_view{};
}

}  // namespace axisgate::server
