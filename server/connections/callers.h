// Who is at the other end of a connection, before anything has been said: the kernel knows.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace axisgate::server {

// The user who connected; none for a TCP connection.
std::optional<uid_t> peer_uid(int connection);

// The owner of that connection, as far as limits go: "uid 1000", or the machine's address, "192.168.0.7". All callers
// over loopback count as one owner, since a caller there can choose among 16 million addresses.
std::string connection_owner(int connection);

// "unix alice", after the machine's own /etc/passwd, or "unix uid 1234". Directories over the network are not asked:
// a stop would wait for them.
std::string caller_name(uid_t uid);

// gRPC 1.51 has no name for the client of a Unix socket, and takes one only for a whole endpoint. So there is an
// endpoint for each user, made before anybody connects. The first user gets the first; surplus users share the last.
class CallerSlots {
 public:
  explicit CallerSlots(std::size_t slots);

  std::size_t size() const { return names_.size(); }
  std::size_t slot_of(uid_t uid);  // from one thread

  // Of the users of a slot, "unix" for the shared one. From any thread, once slot_of() has returned the slot.
  const std::string& name(std::size_t slot) const { return names_[slot]; }

 private:
  std::vector<uid_t> users_;
  std::vector<std::string> names_;
};

}  // namespace axisgate::server
