// Fixtures for the tests of server/connections: a listening socket with clients, and a process without free
// descriptors.
#pragma once

#include <dirent.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "device/link/descriptor.h"
#include "tests/unit/link/link_fixtures.h"

namespace axisgate::server {

// A listening Unix socket. Clients can be created before descriptors run out and connected afterwards.
class UnixServer {
 public:
  UnixServer() : listener_(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
    address_.sun_family = AF_UNIX;
    path_.copy(address_.sun_path, sizeof(address_.sun_path) - 1);
    EXPECT_EQ(::bind(listener_.get(), reinterpret_cast<const sockaddr*>(&address_), sizeof(address_)), 0);
    EXPECT_EQ(::listen(listener_.get(), 64), 0);
  }

  Descriptor take_listener() { return std::move(listener_); }

  static Descriptor client() { return Descriptor(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)); }
  void connect(const Descriptor& client) const {
    EXPECT_EQ(::connect(client.get(), reinterpret_cast<const sockaddr*>(&address_), sizeof(address_)), 0);
  }
  Descriptor connected() const {
    Descriptor made = client();
    connect(made);
    return made;
  }

 private:
  link_test::TemporaryDirectory directory_;
  const std::string path_ = directory_ / "server.sock";
  sockaddr_un address_{};
  Descriptor listener_;
};

// Reports whether the other end has closed the connection.
inline bool ended(const Descriptor& client) {
  pollfd poll{client.get(), POLLRDHUP, 0};
  return ::poll(&poll, 1, 0) == 1 && (poll.revents & (POLLRDHUP | POLLHUP)) != 0;
}

inline std::size_t open_descriptors() {
  const std::unique_ptr<DIR, void (*)(DIR*)> open(::opendir("/proc/self/fd"), [](DIR* given) { ::closedir(given); });
  std::size_t count = 0;
  while (::readdir(open.get()) != nullptr) ++count;
  return count;
}

// While a NoDescriptors exists, the process gets no further descriptor; the number of a closed one can be used again.
class NoDescriptors {
 public:
  NoDescriptors() {
    ::getrlimit(RLIMIT_NOFILE, &before_);
    // The limit is above every descriptor in use: a limit closes nothing, and numbers below it can be used again.
    const Descriptor highest(::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 256));
    rlimit none = before_;
    none.rlim_cur = static_cast<rlim_t>(highest.get());
    ::setrlimit(RLIMIT_NOFILE, &none);
    for (;;) {
      Descriptor filler(::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 0));
      if (!filler.valid()) break;
      fillers_.push_back(std::move(filler));
    }
  }
  ~NoDescriptors() { ::setrlimit(RLIMIT_NOFILE, &before_); }
  NoDescriptors(const NoDescriptors&) = delete;
  NoDescriptors& operator=(const NoDescriptors&) = delete;

 private:
  rlimit before_{};
  std::vector<Descriptor> fillers_;
};

}  // namespace axisgate::server
