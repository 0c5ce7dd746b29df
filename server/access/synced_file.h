// Files of the state directory. They survive a power cut whole: what was there before, or all that is new.
#pragma once

#include <string>

#include "device/core/problem.h"
#include "device/link/descriptor.h"

namespace axisgate::server {

// For the daemon's user alone, where it is missing. What goes wrong shows when something is written there.
void make_state_directory(const std::string& path);

// Open with these flags and O_NOFOLLOW, without waiting. Not valid, where nothing is there and nothing could be made.
// internal, with the reason: it is no regular file, others may write it, or it cannot be opened.
Result<Descriptor> open_state_file(const std::string& path, int flags);

// Empty, where there is none. internal, as above, or where it cannot be read.
Result<std::string> read_state_file(const std::string& path);

// For the daemon's user alone. Makes the directory, if it is missing. internal, with the reason.
Result<void> replace_synced(const std::string& path, const std::string& text);

}  // namespace axisgate::server
