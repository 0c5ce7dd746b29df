// Which of the connections that were handed over are still open.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <mutex>
#include <string>
#include <vector>

namespace axisgate::server {

// gRPC closes a connection itself and reports that to nobody. So each connection is identified by its descriptor and
// its inode, and is checked when the number matters. Thread safe.
class OpenConnections {
 public:
  // At most `limit` have room, and of these at most `limit_of_one` of one owner.
  OpenConnections(std::size_t limit, std::size_t limit_of_one) : limit_(limit), limit_of_one_(limit_of_one) {}

  bool has_room();
  bool has_room_for(const std::string& owner);
  // Before it is handed over: afterwards the number may be another's at any time.
  void add(int descriptor, std::string owner);
  std::size_t count();

 private:
  struct Connection {
    int descriptor;
    ino_t inode;  // the kernel gives every socket one of its own
    std::string owner;
  };
  void forget_closed();

  const std::size_t limit_;
  const std::size_t limit_of_one_;
  std::mutex mutex_;
  std::vector<Connection> connections_;  // those closed since the last look among them
};

}  // namespace axisgate::server
