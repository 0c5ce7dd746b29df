// The sockets on which the daemon listens. Each error about an address names a remedy.
#pragma once

#include <sys/stat.h>

#include <string>
#include <utility>

#include "device/core/problem.h"
#include "device/link/descriptor.h"
#include "server/config/config.h"

namespace axisgate::server {

// Listens at `address` on a non-blocking socket. Port 0 takes any free port, and `address` then contains it.
Result<Descriptor> listen_on(TcpAddress& address);

// A UnixListener is a listening Unix socket with its file. Every local user may connect, as to the loopback port; the
// directory decides who reaches the socket.
class UnixListener {
 public:
  // Makes the directory (one level) if it is missing: 0755 under /run, otherwise 0700. Removes an old socket on which
  // nobody listens. Fails for a directory in /tmp that belongs to or is writable by others, a path that is not a
  // socket, and a socket that another process serves.
  static Result<UnixListener> open(const std::string& path);
  // Removes the file, unless it has been replaced by another.
  ~UnixListener();
  UnixListener(UnixListener&& other) noexcept = default;
  UnixListener& operator=(UnixListener&&) = delete;

  // Returns the non-blocking socket; the file stays with this object.
  Descriptor take_socket() { return std::move(socket_); }
  const std::string& path() const { return path_; }

 private:
  UnixListener(std::string path, Descriptor socket);

  std::string path_;  // empty once moved from
  Descriptor socket_;
  dev_t device_ = 0;
  ino_t inode_ = 0;
};

}  // namespace axisgate::server
