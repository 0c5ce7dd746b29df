#include "server/connections/reserve.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>

namespace axisgate::server {
namespace {

// Both ways closed: whoever serves it has shut it down.
bool ended(const Descriptor& connection) {
  pollfd poll{connection.get(), 0, 0};
  return ::poll(&poll, 1, 0) == 1 && (poll.revents & (POLLHUP | POLLERR)) != 0;
}

}  // namespace

Reserve::Reserve(std::size_t places) : places_(places) { restore(); }

void Reserve::open_place() {
  forget_ended();
  if (connections_.size() >= places_) {
    // The one that serves it sees its end as if the client had left, and closes its descriptor.
    ::shutdown(connections_.front().get(), SHUT_RDWR);
    connections_.pop_front();
    ++displaced_;
  }
  for (std::size_t i = 0; i < kDescriptorsEach && !spare_.empty(); ++i) spare_.pop_back();
}

void Reserve::keep(int connection) {
  Descriptor second(::fcntl(connection, F_DUPFD_CLOEXEC, 0));
  if (second.valid()) connections_.push_back(std::move(second));
}

bool Reserve::restore() {
  forget_ended();
  // One place more than connections, since the descriptor of a displaced one takes a moment to be closed.
  const std::size_t wanted = (places_ + 1 - connections_.size()) * kDescriptorsEach;
  while (spare_.size() < wanted) {
    Descriptor spare(::open("/dev/null", O_RDONLY | O_CLOEXEC));
    if (!spare.valid()) return false;
    spare_.push_back(std::move(spare));
  }
  return connections_.empty();
}

void Reserve::forget_ended() { std::erase_if(connections_, ended); }

}  // namespace axisgate::server
