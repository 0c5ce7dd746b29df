// Count of the connections that are still open after they were handed over.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <mutex>
#include <string>
#include <vector>

namespace axisgate::server {

// gRPC closes a connection itself without a report. So each connection is identified by its descriptor and its inode,
// and is checked when the count is needed. Thread safe.
class OpenConnections {
 public:
  // Limits all connections to `limit`, and those of one owner to `limit_of_one`.
  OpenConnections(std::size_t limit, std::size_t limit_of_one) : limit_(limit), limit_of_one_(limit_of_one) {}

  bool has_room();
  bool has_room_for(const std::string& owner);
  // Call it before the connection is handed over: afterwards, the descriptor's number may be reused at any time.
  void add(int descriptor, std::string owner);
  std::size_t count();

 private:
  struct Connection {
    int descriptor;
    ino_t inode;  // unique for each socket
    std::string owner;
  };
  void forget_closed();

  const std::size_t limit_;
  const std::size_t limit_of_one_;
  std::mutex mutex_;
  std::vector<Connection> connections_;  // includes those closed since the last check
};

}  // namespace axisgate::server
