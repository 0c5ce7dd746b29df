#include "server/connections/callers.h"

#include <fmt/format.h>
#include <netdb.h>
#include <pwd.h>
#include <sys/socket.h>

#include <array>
#include <cstdio>
#include <memory>

#include "device/core/escape.h"
#include "server/access/access.h"
#include "server/connections/loopback_peer.h"

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

constexpr const char* kGone = "nobody";

struct Address {
  std::string host;
  std::string port;
};

// Returns host and port as numbers. nullopt if the connection has gone.
std::optional<Address> address_of_peer(int connection) {
  sockaddr_storage address{};
  socklen_t size = sizeof(address);
  std::array<char, NI_MAXHOST> host{};
  std::array<char, NI_MAXSERV> port{};
  auto* generic = reinterpret_cast<sockaddr*>(&address);
  if (::getpeername(connection, generic, &size) != 0) return std::nullopt;
  const int numeric = NI_NUMERICHOST | NI_NUMERICSERV;
  if (::getnameinfo(generic, size, host.data(), host.size(), port.data(), port.size(), numeric) != 0) {
    return std::nullopt;
  }
  return Address{host.data(), port.data()};
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
  if (const std::optional<uid_t> user = loopback_uid(connection)) return fmt::format("uid {} over TCP", *user);
  const std::optional<Address> address = address_of_peer(connection);
  if (!address) return kGone;
  return address->host.starts_with("127.") ? "127.0.0.1" : address->host;
}

std::string peer_address(int connection) {
  const std::optional<Address> address = address_of_peer(connection);
  if (!address) return kGone;
  const bool v6 = address->host.find(':') != std::string::npos;
  return fmt::format(fmt::runtime(v6 ? "[{}]:{}" : "{}:{}"), address->host, address->port);
}

std::string caller_name(uid_t uid) {
  const std::optional<std::string> login = login_name(uid);
  return login ? "unix " + escaped(*login) : fmt::format("unix uid {}", uid);
}

}  // namespace axisgate::server
