#include "device/link/socket_pair.h"

#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <system_error>

namespace axisgate {

Result<SocketPair> open_socket_pair() {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    return fail(Reason::link_down,
                "no line inside the process: socketpair failed: " + std::generic_category().message(errno));
  }
  return SocketPair{ends[0], ends[1]};
}

Opener line_to(Runner& device) {
  return opener_on_strand([&device] {
    return open_socket_pair().map([&](const SocketPair& pair) {
      device.adopt(pair.device);
      return Descriptor(pair.host);
    });
  });
}

}  // namespace axisgate
