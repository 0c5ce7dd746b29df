#include "server/endpoints.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netdb.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <system_error>

#include "device/link/descriptor.h"

namespace axisgate::server {
namespace {

std::string error_text(int error) { return std::generic_category().message(error); }

tl::unexpected<Problem> refuse(std::string message, std::string hint) {
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

// Whether a connection is accepted there; any other error than a refusal counts as somebody, who is left alone.
bool somebody_listens(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, sizeof(address.sun_path) - 1);
  const Descriptor probe(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  return ::connect(probe.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0 ||
         errno != ECONNREFUSED;
}

Result<void> prepare_directory(const std::filesystem::path& directory) {
  const bool shared = directory.native().starts_with("/run/");
  if (::mkdir(directory.c_str(), shared ? 0755 : 0700) == 0) return {};
  if (errno != EEXIST) {
    return refuse(
        fmt::format("cannot make the directory {} for the Unix socket: {}", directory.native(), error_text(errno)),
        "set another path with the key `socket` in the configuration");
  }
  struct stat status {};
  const bool directory_there = ::stat(directory.c_str(), &status) == 0 && S_ISDIR(status.st_mode);
  // Under /tmp anybody may have made it first, to put a socket of theirs in the place of ours.
  const bool ours = status.st_uid == ::geteuid() && (status.st_mode & (S_IWGRP | S_IWOTH)) == 0;
  const bool in_tmp = directory.parent_path() == "/tmp";
  if (directory_there && (ours || !in_tmp)) return {};
  return refuse(fmt::format("{} is not a directory that only this user may write to", directory.native()),
                "remove it, or set another path with the key `socket` in the configuration");
}

}  // namespace

Result<void> check_port_free(const TcpAddress& address) {
  const Addresses where = resolve(address);
  if (where == nullptr) return refuse(to_string(address) + " is not an address of this machine", "");
  const Descriptor probe(::socket(where->ai_family, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const int on = 1;
  ::setsockopt(probe.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
  if (::bind(probe.get(), where->ai_addr, where->ai_addrlen) == 0) return {};
  return refuse(fmt::format("cannot listen on {}: {}", to_string(address), error_text(errno)),
                errno == EADDRINUSE ? "stop the program that holds the port (another axisgated?), or set another "
                                      "address with the key `listen` in the configuration"
                                    : "set another address with the key `listen` in the configuration");
}

Result<void> prepare_socket(const std::string& path) {
  const Result<void> directory = prepare_directory(std::filesystem::path(path).parent_path());
  if (!directory) return directory;
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0) return {};
  if (!S_ISSOCK(status.st_mode)) {
    return refuse(path + " is there already and is not a socket",
                  "move it away, or set another path with the key `socket` in the configuration");
  }
  if (somebody_listens(path)) {
    return refuse(path + " is served by another process already",
                  "stop it (another axisgated?), or set another path with the key `socket` in the configuration");
  }
  if (::unlink(path.c_str()) == 0) return {};
  return refuse(fmt::format("cannot remove the old socket {}: {}", path, error_text(errno)),
                "remove it, or set another path with the key `socket` in the configuration");
}

void open_socket_to_users(const std::string& path) { ::chmod(path.c_str(), 0666); }

}  // namespace axisgate::server
