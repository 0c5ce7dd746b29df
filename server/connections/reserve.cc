#include "server/connections/reserve.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

namespace axisgate::server {
namespace {

// Reports whether the server side has shut the connection down in both directions.
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
  // To the server side, this looks as if the client had left, so it closes its descriptor.
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
  // One more place, so that a new connection need not wait until the connection that it displaces has been closed.
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
