// The file of a job that is sent.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace axisgate::axisctl {

// Both: "-" is the standard input.

// Throws Failure if there is no regular file of that name: a FIFO or a device may never end.
void check_job_file(const std::string& name);

// Reads it in pieces, which `take` receives, and returns how many bytes it has. Throws Failure before it is read if it
// has more than `most` bytes (0: any number), and afterwards if it was written to meanwhile.
std::int64_t read_job_file(const std::string& name, std::int64_t most,
                           const std::function<void(std::string_view)>& take);

}  // namespace axisgate::axisctl
