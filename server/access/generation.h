// Which start of the daemon this is, for fencing tokens that grow over restarts.
#pragma once

#include <cstdint>
#include <string>

#include "device/core/problem.h"

namespace axisgate::server {

struct NewGeneration {
  std::uint32_t number = 0;
  Result<void> kept;  // internal, where it cannot be written: the message says why
};

// Greater than at every earlier start that kept its own in the file `generation` of this directory, and than the
// seconds since 1970 at those that could not keep it. One synced write. internal, where the file cannot be read.
Result<NewGeneration> next_generation(const std::string& state_directory, std::uint32_t seconds_since_1970);

}  // namespace axisgate::server
