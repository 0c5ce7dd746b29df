#include "device/link/socket_file.h"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace axisgate {
namespace {

tl::unexpected<Problem> refuse_path(const std::string& path, const std::string& why, std::string hint) {
  return fail(Reason::invalid_request, fmt::format("control socket {}: {}", path, why), std::move(hint));
}

tl::unexpected<Problem> refuse_path(const std::string& path, const std::string& why, int error) {
  return refuse_path(path, fmt::format("{}: {}", why, std::generic_category().message(error)), "Choose another path.");
}

sockaddr_un address_of(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, sizeof(address.sun_path) - 1);
  return address;
}

// Reports whether a process listens at the path. Any error other than a refused connection counts as one that must be
// left alone, such as a full backlog (EAGAIN).
bool somebody_listens(const std::string& path) {
  const sockaddr_un address = address_of(path);
  const Descriptor probe(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  return ::connect(probe.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0 ||
         errno != ECONNREFUSED;
}

Result<void> clear_path(const std::string& path) {
  if (path.size() >= sizeof(sockaddr_un::sun_path)) {
    return refuse_path(path, fmt::format("longer than {} characters", sizeof(sockaddr_un::sun_path) - 1),
                       "Choose a shorter path.");
  }
  struct stat status {};
  if (path.empty() || ::lstat(path.c_str(), &status) != 0) return {};
  if (!S_ISSOCK(status.st_mode)) {
    return refuse_path(path, "something that is not a socket is already there", "Choose another name.");
  }
  if (somebody_listens(path)) {
    return refuse_path(path, "another process serves it", "End that one, or choose another name.");
  }
  if (::unlink(path.c_str()) != 0) return refuse_path(path, "the old socket cannot be removed", errno);
  return {};
}

}  // namespace

SocketFile::SocketFile(std::string path, Descriptor socket) : path_(std::move(path)), socket_(std::move(socket)) {
  struct stat status {};
  if (::lstat(path_.c_str(), &status) != 0) return;
  device_ = status.st_dev;
  inode_ = status.st_ino;
}

SocketFile::SocketFile(SocketFile&& other) noexcept
    : path_(std::exchange(other.path_, {})),
      socket_(std::move(other.socket_)),
      device_(other.device_),
      inode_(other.inode_) {}

SocketFile::~SocketFile() {
  struct stat status {};
  if (path_.empty() || ::lstat(path_.c_str(), &status) != 0) return;
  if (status.st_dev == device_ && status.st_ino == inode_) ::unlink(path_.c_str());
}

Result<SocketFile> SocketFile::open(const std::string& path) {
  if (auto clear = clear_path(path); !clear) return tl::unexpected(clear.error());
  const sockaddr_un address = address_of(path);
  Descriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (path.empty() || ::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    return refuse_path(path, "it cannot be made", path.empty() ? ENOENT : errno);
  }
  // The file exists from here on, and is removed with this object. Nobody can connect before the socket listens.
  SocketFile file(path, std::move(socket));
  if (::chmod(path.c_str(), S_IRUSR | S_IWUSR) != 0 || ::listen(file.socket_.get(), SOMAXCONN) != 0) {
    return refuse_path(path, "nobody can be let in", errno);
  }
  return file;
}

}  // namespace axisgate
