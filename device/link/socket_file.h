// Unix socket file on which a simulator is controlled: for this user alone, and removed at the program's end.
#pragma once

#include <sys/types.h>

#include <string>
#include <utility>

#include "device/core/problem.h"
#include "device/link/descriptor.h"

namespace axisgate {

class SocketFile {
 public:
  // Opens a non-blocking stream socket that listens at `path`, with mode 0600. Removes a socket at the path if nobody
  // listens on it any longer. Fails with invalid_request if a process serves the socket, or if the path is something
  // else.
  static Result<SocketFile> open(const std::string& path);
  // Removes the file, unless it was replaced by another.
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
