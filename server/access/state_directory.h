// Directory of the files that outlive the daemon.
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "device/core/problem.h"
#include "device/link/descriptor.h"

namespace axisgate::server {

// Returns $STATE_DIRECTORY (systemd); else /var/lib/axisgate for root; else $XDG_STATE_HOME/axisgate or
// ~/.local/state/axisgate.
std::string default_state_directory();

// A StateDirectory locks the directory for one daemon as long as the object exists, because two daemons would overwrite
// each other's files. The kernel ends the lock with the process, so a killed daemon leaves no lock.
class StateDirectory {
 public:
  // Makes the directory if it is missing, and locks it. Follows a symbolic link in `path` once: path() has none. Fails
  // with internal if another daemon has the lock; if others may write there; if `path` has a link and others may write
  // a folder above the directory; or if `path` is a link to nothing. The message names the user or process, and the
  // path. A directory in which no lock file can be made stays unlocked, because nothing can be stored there either.
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
