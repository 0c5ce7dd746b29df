// Check that nobody else may change a file that decides what the daemon does.
#pragma once

#include <sys/stat.h>

#include <string>

#include "device/core/problem.h"

namespace axisgate::server {

// Fails with invalid_request if anybody except root, the daemon's user and the daemon's group may write the file, or
// could permit themselves to. The message follows the path: "may be written by ..."; the hint is the command that
// corrects it.
Result<void> check_writers(const std::string& path, const struct stat& status);

// Does the same for the file at this path. Succeeds if the file cannot be examined: the code that opens it reports why.
// Ignores owner and group on a file system that is mounted read-only, because a container receives files of unknown
// users on such a file system.
Result<void> check_writers(const std::string& path);

}  // namespace axisgate::server
