#include "server/connections/endpoints.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

#include "device/link/descriptor.h"

namespace axisgate::server {
namespace {

std::string error_text(int error) { return std::generic_category().message(error); }

tl::unexpected<Problem> refuse_address(std::string message, std::string hint) {
  return fail(Reason::internal, std::move(message), std::move(hint));
}

using Addresses = std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)>;

Addresses resolve(const TcpAddress& address) {
  addrinfo hints{};
  hints.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV | AI_PASSIVE;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  ::getaddrinfo(address.host.c_str(), std::to_string(address.port).c_str(), &hints, &found);
  return {found, &::freeaddrinfo};
}

sockaddr_un unix_address(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, sizeof(address.sun_path) - 1);
  return address;
}

// Reports whether a process serves the socket. Any error other than a refusal counts as served, so the socket is kept.
bool somebody_listens(const std::string& path) {
  const sockaddr_un address = unix_address(path);
  const Descriptor probe(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  return ::connect(probe.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0 ||
         errno != ECONNREFUSED;
}

Result<void> prepare_directory(const std::filesystem::path& directory) {
  const bool shared = directory.native().starts_with("/run/");
  if (::mkdir(directory.c_str(), shared ? 0755 : 0700) == 0) return {};
  if (errno != EEXIST) {
    return refuse_address(
        fmt::format("cannot make the directory {} for the Unix socket: {}", directory.native(), error_text(errno)),
        "set another path with the key `socket` in the configuration");
  }
  struct stat status {};
  const bool directory_there = ::stat(directory.c_str(), &status) == 0 && S_ISDIR(status.st_mode);
  // Under /tmp, another user may have made the directory first, to replace the daemon's socket.
  const bool ours = status.st_uid == ::geteuid() && (status.st_mode & (S_IWGRP | S_IWOTH)) == 0;
  const bool in_tmp = directory.parent_path() == "/tmp";
  if (directory_there && (ours || !in_tmp)) return {};
  return refuse_address(fmt::format("{} is not a directory that only this user may write to", directory.native()),
                        "remove it, or set another path with the key `socket` in the configuration");
}

Result<void> prepare_path(const std::string& path) {
  const Result<void> directory = prepare_directory(std::filesystem::path(path).parent_path());
  if (!directory) return directory;
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0) return {};
  if (!S_ISSOCK(status.st_mode)) {
    return refuse_address(path + " is there already and is not a socket",
                          "move it away, or set another path with the key `socket` in the configuration");
  }
  if (somebody_listens(path)) {
    return refuse_address(
        path + " is served by another process already",
        "stop it (another axisgated?), or set another path with the key `socket` in the configuration");
  }
  if (::unlink(path.c_str()) == 0) return {};
  return refuse_address(fmt::format("cannot remove the old socket {}: {}", path, error_text(errno)),
                        "remove it, or set another path with the key `socket` in the configuration");
}

tl::unexpected<Problem> refuse_address(const TcpAddress& address, int error) {
  return refuse_address(fmt::format("cannot listen on {}: {}", to_string(address), error_text(error)),
                        error == EADDRINUSE
                            ? "stop the program that holds the port (another axisgated?), or set another "
                              "address with the key `listen` in the configuration"
                            : "set another address with the key `listen` in the configuration");
}

std::uint16_t port_of(const Descriptor& socket) {
  sockaddr_storage address{};
  socklen_t size = sizeof(address);
  ::getsockname(socket.get(), reinterpret_cast<sockaddr*>(&address), &size);
  // sockaddr_in6 has its port at the same place.
  return ntohs(reinterpret_cast<const sockaddr_in&>(address).sin_port);
}

}  // namespace

Result<Descriptor> listen_on(TcpAddress& address) {
  const Addresses where = resolve(address);
  if (where == nullptr) return refuse_address(to_string(address) + " is not an address of this machine", "");
  Descriptor socket(::socket(where->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  // Lets the daemon restart without waiting for the previous run's connections to time out.
  const int on = 1;
  ::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
  if (::bind(socket.get(), where->ai_addr, where->ai_addrlen) != 0 || ::listen(socket.get(), SOMAXCONN) != 0) {
    return refuse_address(address, errno);
  }
  address.port = port_of(socket);
  return socket;
}

UnixListener::UnixListener(std::string path, Descriptor socket) : path_(std::move(path)), socket_(std::move(socket)) {
  struct stat status {};
  if (::lstat(path_.c_str(), &status) != 0) return;
  device_ = status.st_dev;
  inode_ = status.st_ino;
}

UnixListener::~UnixListener() {
  struct stat status {};
  if (path_.empty() || ::lstat(path_.c_str(), &status) != 0) return;
  if (status.st_dev == device_ && status.st_ino == inode_) ::unlink(path_.c_str());
}

Result<UnixListener> UnixListener::open(const std::string& path) {
  if (const Result<void> ready = prepare_path(path); !ready) return tl::unexpected(ready.error());
  const sockaddr_un address = unix_address(path);
  Descriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    return refuse_address(fmt::format("cannot make the socket {}: {}", path, error_text(errno)),
                          "set another path with the key `socket` in the configuration");
  }
  // From here on the file exists, and `listener` removes it.
  UnixListener listener(path, std::move(socket));
  if (::chmod(path.c_str(), 0666) != 0 || ::listen(listener.socket_.get(), SOMAXCONN) != 0) {
    return refuse_address(fmt::format("cannot listen on the socket {}: {}", path, error_text(errno)),
                          "set another path with the key `socket` in the configuration");
  }
  return listener;
}

}  // namespace axisgate::server
