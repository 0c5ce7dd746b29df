// Line without hardware: two connected sockets inside the process, one for the host and one for a simulator.
#pragma once

#include "device/core/problem.h"
#include "device/link/runner.h"

namespace axisgate {

// Two connected, non-blocking descriptors; the caller must close both.
struct SocketPair {
  int host = -1;
  int device = -1;
};
Result<SocketPair> open_socket_pair();

// Returns an opener for the host's Runner. Every call makes a new pair and passes the other end to `device`, a Runner
// without an opener, which must outlive the host's Runner. A host can therefore close and reopen the line like a real
// port.
Opener line_to(Runner& device);

}  // namespace axisgate
