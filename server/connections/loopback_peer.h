// Who is at the other end of a TCP connection over loopback: the kernel knows.
#pragma once

#include <sys/types.h>

#include <optional>

namespace axisgate::server {

// The user whose socket it is, asked of the kernel by sock_diag(7). Nothing for a peer on another machine, for one that
// has gone, and where the kernel does not say.
std::optional<uid_t> loopback_uid(int connection);

}  // namespace axisgate::server
