// A line without hardware: two connected sockets inside the process, the host at one end and a simulator at the other.
#pragma once

#include "device/core/problem.h"
#include "device/link/runner.h"

namespace axisgate {

// Two connected, non-blocking descriptors; the caller closes both.
struct SocketPair {
  int host = -1;
  int device = -1;
};
Result<SocketPair> open_socket_pair();

// An opener for the host's Runner: every call makes a new pair and hands its other end to `device`, a Runner without
// an opener, which must outlive the host's. So a host may close and reopen as with a real port.
Opener line_to(Runner& device);

}  // namespace axisgate
