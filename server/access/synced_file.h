// Files that survive a power cut whole: what was there before, or all that is new.
#pragma once

#include <string>

#include "device/core/problem.h"

namespace axisgate::server {

// For the daemon's user alone. Makes the directory, if it is missing. internal, with the reason.
Result<void> replace_synced(const std::string& path, const std::string& text);

}  // namespace axisgate::server
