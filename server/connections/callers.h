// Who is at the other end of a connection, before anything has been said: the kernel knows.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>

namespace axisgate::server {

// The user who connected; none for a TCP connection.
std::optional<uid_t> peer_uid(int connection);

// The owner of that connection, as far as limits go: "uid 1000", "uid 1000 over TCP" on this machine, or the machine's
// address, "192.168.0.7". Where the kernel does not name a peer over loopback, all of these are one owner, since a
// caller there can choose among 16 million addresses.
std::string connection_owner(int connection);

// Of a TCP connection: "127.0.0.1:39482", "[::1]:39482"; "nobody" once it has gone.
std::string peer_address(int connection);

// "unix alice", after the machine's own /etc/passwd, or "unix uid 1234". Directories over the network are not asked:
// a stop would wait for them.
std::string caller_name(uid_t uid);

}  // namespace axisgate::server
