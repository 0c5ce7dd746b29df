// Files of the state directory. After a power cut each has either its old content or all of the new content.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "device/core/problem.h"
#include "device/link/descriptor.h"

namespace axisgate::server {

// Makes a missing directory for the daemon's user only. Problems become visible when something is written there.
void make_state_directory(const std::string& path);

// Opens a file with these flags and O_NOFOLLOW, without waiting. Returns an invalid descriptor if there is no file and
// none could be made. Fails with internal, and says why, if it is not a regular file, others may write it, or it cannot
// be opened.
Result<Descriptor> open_state_file(const std::string& path, int flags);

// Passes on the content of an open file, piece by piece. Fails with internal if it cannot be read.
Result<void> read_pieces(int file, const std::string& path, const std::function<void(std::string_view)>& take);

// Returns the content of a file; empty if there is none. Fails with internal as open_state_file() does, or if the file
// cannot be read.
Result<std::string> read_state_file(const std::string& path);

// Replaces a file, for the daemon's user only. Makes the directory if it is missing. Fails with internal, and says why.
Result<void> replace_synced(const std::string& path, const std::string& text);

// Writes all bytes, in as many writes as necessary. Returns false, with errno, if not all were written.
bool write_all(int file, std::string_view bytes);

// Returns the problem of a write that has just failed: internal, with the text of errno.
tl::unexpected<Problem> cannot_write(const std::string& path);

// Makes the names in a directory survive a power cut. Fails with internal if they may not.
Result<void> sync_directory(const std::string& path);

}  // namespace axisgate::server
