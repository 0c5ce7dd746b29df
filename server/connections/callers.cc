#include "server/connections/callers.h"

#include <fmt/format.h>
#include <netdb.h>
#include <pwd.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>

#include "device/core/escape.h"
#include "server/access/access.h"

namespace axisgate::server {
namespace {

std::optional<std::string> login_name(uid_t uid) {
  const std::unique_ptr<std::FILE, void (*)(std::FILE*)> file(std::fopen("/etc/passwd", "re"),
                                                              [](std::FILE* open) { std::fclose(open); });
  if (file == nullptr) return std::nullopt;
  passwd entry{};
  passwd* found = nullptr;
  std::array<char, 4096> buffer{};
  while (::fgetpwent_r(file.get(), &entry, buffer.data(), buffer.size(), &found) == 0) {
    if (found->pw_uid == uid) return found->pw_name;
  }
  return std::nullopt;
}

}  // namespace

std::optional<uid_t> peer_uid(int connection) {
  int domain = 0;
  socklen_t size = sizeof(domain);
  if (::getsockopt(connection, SOL_SOCKET, SO_DOMAIN, &domain, &size) != 0 || domain != AF_UNIX) return std::nullopt;
  ucred peer{};
  size = sizeof(peer);
  if (::getsockopt(connection, SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0) return std::nullopt;
  return peer.uid;
}

std::string connection_owner(int connection) {
  if (const std::optional<uid_t> user = peer_uid(connection)) return fmt::format("uid {}", *user);
  sockaddr_storage address{};
  socklen_t size = sizeof(address);
  std::array<char, NI_MAXHOST> host{};
  const auto* generic = reinterpret_cast<const sockaddr*>(&address);
  if (::getpeername(connection, reinterpret_cast<sockaddr*>(&address), &size) != 0 ||
      ::getnameinfo(generic, size, host.data(), host.size(), nullptr, 0, NI_NUMERICHOST) != 0) {
    return "nobody";  // who has gone again already
  }
  const std::string text = host.data();
  return text.starts_with("127.") ? "127.0.0.1" : text;
}

std::string caller_name(uid_t uid) {
  const std::optional<std::string> login = login_name(uid);
  return login ? "unix " + escaped(*login) : fmt::format("unix uid {}", uid);
}

CallerSlots::CallerSlots(std::size_t slots) : names_(slots, std::string(kSharedUnixName)) {}

std::size_t CallerSlots::slot_of(uid_t uid) {
  const auto found = std::find(users_.begin(), users_.end(), uid);
  const auto slot = static_cast<std::size_t>(found - users_.begin());
  if (found != users_.end() || slot + 1 == names_.size()) return slot;
  users_.push_back(uid);
  names_[slot] = caller_name(uid);
  return slot;
}

}  // namespace axisgate::server
