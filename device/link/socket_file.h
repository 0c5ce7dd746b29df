// The Unix socket on which a simulator is controlled, as a file: for this user alone, and gone at the program's end.
#pragma once

#include <sys/types.h>

#include <string>
#include <utility>

#include "device/core/problem.h"
#include "device/link/descriptor.h"

namespace axisgate {

class SocketFile {
 public:
  // A non-blocking stream socket that listens at `path`, mode 0600. Removes a socket there that nobody listens on any
  // more; refuses one that somebody serves, and anything that is no socket.
  static Result<SocketFile> open(const std::string& path);
  // Removes the file, unless another has been put in its place.
  ~SocketFile();
  SocketFile(SocketFile&& other) noexcept;
  SocketFile& operator=(SocketFile&&) = delete;

  Descriptor take_socket() { return std::move(socket_); }

 private:
  SocketFile(std::string path, Descriptor socket);

  std::string path_;  // empty once moved from
  Descriptor socket_;
  dev_t device_ = 0;
  ino_t inode_ = 0;
};

}  // namespace axisgate
