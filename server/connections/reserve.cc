#include "server/connections/reserve.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

namespace axisgate::server {
namespace {

// Closed in both directions: the server side has shut it down.
bool ended(const Descriptor& connection) {
  pollfd poll{connection.get(), 0, 0};
  return ::poll(&poll, 1, 0) == 1 && (poll.revents & (POLLHUP | POLLERR)) != 0;
}

}  // namespace

Reserve::Reserve(std::size_t places) : places_(places) { restore(); }

bool Reserve::open_place() {
  restore();
  if (spare_.size() < kDescriptorsEach) return false;
  spare_.resize(spare_.size() - kDescriptorsEach);
  if (connections_.size() < places_) return true;
  // The server side sees its end as if the client had left, and closes its descriptor.
  ::shutdown(connections_.front().get(), SHUT_RDWR);
  connections_.pop_front();
  ++displaced_;
  return true;
}

void Reserve::keep(int connection) {
  Descriptor second(::fcntl(connection, F_DUPFD_CLOEXEC, 0));
  if (second.valid()) connections_.push_back(std::move(second));
}

bool Reserve::restore() {
  forget_ended();
  // One place more, so that a newcomer need not wait until the one that it displaces has been closed.
  const std::size_t wanted = (places_ + 1 - connections_.size()) * kDescriptorsEach;
  while (spare_.size() < wanted) {
    Descriptor spare(::eventfd(0, EFD_CLOEXEC));
    if (!spare.valid()) return false;
    spare_.push_back(std::move(spare));
  }
  return true;
}

void Reserve::forget_ended() { std::erase_if(connections_, ended); }

}  // namespace axisgate::server
