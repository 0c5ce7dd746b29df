// Who else may change a file that decides what the daemon does.
#pragma once

#include <sys/stat.h>

#include <string>

#include "device/core/problem.h"

namespace axisgate::server {

// invalid_request where somebody may write it, or may allow themselves to, beside root, the daemon's user and the
// daemon's group. The message follows on the path, "may be written by ..."; the hint is the command that corrects it.
Result<void> check_writers(const std::string& path, const struct stat& status);

// As above, of the file at this path. If it cannot be looked at, the code that opens it says why. Owner and group do
// not matter on a file system that is mounted read-only: a container receives files of users whom it does not know like
// this.
Result<void> check_writers(const std::string& path);

}  // namespace axisgate::server
