// The sockets that the daemon listens on. Errors about an address are worded so that a person can fix it.
#pragma once

#include <sys/stat.h>

#include <string>
#include <utility>

#include "device/core/problem.h"
#include "device/link/descriptor.h"
#include "server/config/config.h"

namespace axisgate::server {

// Listens there, on a non-blocking socket; with port 0 on any free one, which `address` then names.
Result<Descriptor> listen_on(TcpAddress& address);

// A Unix socket that is listened on, and its file. Every local user may connect, as to the loopback port; the directory
// decides who reaches the socket.
class UnixListener {
 public:
  // Makes the directory, one level, if it is missing (0755 under /run, else 0700: for this user alone) and removes a
  // socket that nobody listens on any more. Refuses a directory in /tmp that is another's or open to others, a path
  // that is not a socket, and a socket that somebody serves.
  static Result<UnixListener> open(const std::string& path);
  // Removes the file, unless another has been put in its place.
  ~UnixListener();
  UnixListener(UnixListener&& other) noexcept = default;
  UnixListener& operator=(UnixListener&&) = delete;

  // The non-blocking socket; the file stays this object's.
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
