// The directory in which the daemon keeps what outlives it.
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "device/core/problem.h"
#include "device/link/descriptor.h"

namespace axisgate::server {

// $STATE_DIRECTORY (systemd), /var/lib/axisgate for root, else $XDG_STATE_HOME/axisgate or ~/.local/state/axisgate.
std::string default_state_directory();

// Held by one daemon at a time, for as long as this lives: two would overwrite each other's files. The kernel ends the
// hold with the process, so a daemon that was killed leaves nothing that is in the way.
class StateDirectory {
 public:
  // Makes the directory, if it is missing. A symbolic link in `path` is followed once: path() has none. Fails with
  // internal if another daemon holds the directory, or others may write there, or if `path` has a link and others may
  // write a folder above the directory, or a link to nothing; the message says who and where. A directory in which no
  // lock can be made is held by nobody: nothing can be kept there either.
  static Result<StateDirectory> hold(const std::string& path);

  std::string file(std::string_view name) const { return path_ + "/" + std::string(name); }
  const std::string& path() const { return path_; }

 private:
  explicit StateDirectory(std::string path) : path_(std::move(path)) {}
  Result<void> lock();

  std::string path_;
  Descriptor lock_;
};

}  // namespace axisgate::server
