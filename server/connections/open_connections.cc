#include "server/connections/open_connections.h"

#include <sys/stat.h>

#include <algorithm>
#include <utility>

namespace axisgate::server {
namespace {

// Returns 0 if the descriptor is not a socket; no socket has inode 0.
ino_t socket_inode(int descriptor) {
  struct stat status {};
  return ::fstat(descriptor, &status) == 0 && S_ISSOCK(status.st_mode) ? status.st_ino : 0;
}

}  // namespace

bool OpenConnections::has_room() {
  const std::lock_guard lock(mutex_);
  if (connections_.size() >= limit_) forget_closed();
  return connections_.size() < limit_;
}

bool OpenConnections::has_room_for(const std::string& owner) {
  const std::lock_guard lock(mutex_);
  const auto of_owner = [&] {
    const auto count = std::ranges::count(connections_, owner, &Connection::owner);
    return static_cast<std::size_t>(count);
  };
  if (of_owner() < limit_of_one_) return true;
  forget_closed();
  return of_owner() < limit_of_one_;
}

void OpenConnections::add(int descriptor, std::string owner) {
  const ino_t inode = socket_inode(descriptor);
  const std::lock_guard lock(mutex_);
  connections_.push_back({descriptor, inode, std::move(owner)});
}

std::size_t OpenConnections::count() {
  const std::lock_guard lock(mutex_);
  forget_closed();
  return connections_.size();
}

void OpenConnections::forget_closed() {
  std::erase_if(connections_,
                [](const Connection& one) { return one.inode == 0 || socket_inode(one.descriptor) != one.inode; });
}

}  // namespace axisgate::server
