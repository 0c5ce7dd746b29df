// Identification of the peer of a new connection by the kernel.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>

namespace axisgate::server {

// Returns the user who connected. nullopt for a TCP connection.
std::optional<uid_t> peer_uid(int connection);

// Returns the owner for connection limits: "uid 1000", "uid 1000 over TCP" on this machine, or the address of another
// machine, "192.168.0.7". If the kernel does not identify a peer over loopback, all addresses in 127.0.0.0/8 are one
// owner, since a caller there can choose among 16 million of them.
std::string connection_owner(int connection);

// Returns the address of a TCP peer: "127.0.0.1:39482", "[::1]:39482"; "nobody" if the connection has gone.
std::string peer_address(int connection);

// Returns "unix alice" according to the machine's own /etc/passwd, or "unix uid 1234". Directories over the network are
// not queried, since a stop would wait for them.
std::string caller_name(uid_t uid);

}  // namespace axisgate::server
