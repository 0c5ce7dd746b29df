// Identification of the peer of a TCP connection over loopback by the kernel.
#pragma once

#include <sys/types.h>

#include <optional>

namespace axisgate::server {

// Returns the user who owns the peer's socket, from sock_diag(7). nullopt for a peer on another machine, a peer that
// has gone, or if the kernel does not answer.
std::optional<uid_t> loopback_uid(int connection);

}  // namespace axisgate::server
