#include "server/connections/open_connections.h"

#include <sys/stat.h>

namespace axisgate::server {
namespace {

// 0 is no socket's.
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

void OpenConnections::add(int descriptor) {
  const ino_t inode = socket_inode(descriptor);
  const std::lock_guard lock(mutex_);
  connections_.push_back({descriptor, inode});
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
