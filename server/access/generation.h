// Which start of the daemon this is, for fencing tokens that grow over restarts.
#pragma once

#include <cstdint>
#include <string>

#include "device/core/problem.h"

namespace axisgate::server {

// Where the daemon keeps what outlives it: $STATE_DIRECTORY (systemd), /var/lib/axisgate for root, else
// $XDG_STATE_HOME/axisgate or ~/.local/state/axisgate.
std::string default_state_directory();

// Greater than at every earlier start that kept its own in the file `generation` of this directory, and than the
// seconds since 1970 at those that could not keep it. One synced write. internal, where the directory cannot be
// written: the message says why.
Result<std::uint32_t> next_generation(const std::string& state_directory, std::uint32_t seconds_since_1970);

}  // namespace axisgate::server
