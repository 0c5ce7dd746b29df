// Files of the state directory. They survive a power cut whole: what was there before, or all that is new.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "device/core/problem.h"
#include "device/link/descriptor.h"

namespace axisgate::server {

// For the daemon's user alone, where it is missing. What goes wrong shows when something is written there.
void make_state_directory(const std::string& path);

// Open with these flags and O_NOFOLLOW, without waiting. Not valid, where nothing is there and nothing could be made.
// internal, with the reason: it is no regular file, others may write it, or it cannot be opened.
Result<Descriptor> open_state_file(const std::string& path, int flags);

// Passes on what is in an open file, piece by piece. internal, where it cannot be read.
Result<void> read_pieces(int file, const std::string& path, const std::function<void(std::string_view)>& take);

// Empty, where there is none. internal, as above, or where it cannot be read.
Result<std::string> read_state_file(const std::string& path);

// For the daemon's user alone. Makes the directory, if it is missing. internal, with the reason.
Result<void> replace_synced(const std::string& path, const std::string& text);

// In as many writes as that takes. False, with errno, where not all was written.
bool write_all(int file, std::string_view bytes);

// Of what has just failed there: internal, with the text of errno.
tl::unexpected<Problem> cannot_write(const std::string& path);

// The names in it outlast a power cut from then on. internal, where they may not.
Result<void> sync_directory(const std::string& path);

}  // namespace axisgate::server
