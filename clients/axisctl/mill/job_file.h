// Reading of a mill's job file.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace axisgate::axisctl {

// In both functions "-" means the standard input.

// Throws Failure if there is no regular file with this name: a FIFO or a device may never end.
void check_job_file(const std::string& name);

// Passes the file to `take` in pieces, and returns its size in bytes. Throws Failure if the file has more than `most`
// bytes (0: no limit), or was written to while it was read.
std::int64_t read_job_file(const std::string& name, std::int64_t most,
                           const std::function<void(std::string_view)>& take);

}  // namespace axisgate::axisctl
