// Number of this start of the daemon, so that fencing tokens grow over restarts.
#pragma once

#include <cstdint>
#include <string>

#include "device/core/problem.h"

namespace axisgate::server {

struct NewGeneration {
  std::uint32_t number = 0;
  Result<void> kept;  // internal if the number cannot be written; the message says why
};

// Returns a number that is greater than the number of every earlier start that kept its number in the file `generation`
// of this directory, and greater than the seconds since 1970 at every earlier start that could not. Makes one synced
// write. Fails with internal if the file cannot be read.
Result<NewGeneration> next_generation(const std::string& state_directory, std::uint32_t seconds_since_1970);

}  // namespace axisgate::server
