// Serial servers on loopback: one that accepts, and one that is silent.
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <array>

#include "device/link/descriptor.h"
#include "device/link/tcp_socket.h"

namespace axisgate::link_test {

// A server that accepts a connection when the test requests it.
class SerialServer {
 public:
  explicit SerialServer(int backlog = 1) : listener_(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = ::htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    EXPECT_EQ(::bind(listener_.get(), reinterpret_cast<const sockaddr*>(&address), size), 0);
    EXPECT_EQ(::listen(listener_.get(), backlog), 0);
    EXPECT_EQ(::getsockname(listener_.get(), reinterpret_cast<sockaddr*>(&address), &size), 0);
    settings_ = {"127.0.0.1", ::ntohs(address.sin_port)};
  }

  const TcpSettings& settings() const { return settings_; }
  Descriptor accept() { return Descriptor(::accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC)); }
  void close() { listener_.reset(); }

 private:
  Descriptor listener_;
  TcpSettings settings_;
};

// The kernel drops packets to a listener whose queue is full, as a network does when there is no host.
class SilentHost {
 public:
  SilentHost() : server_(0) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = ::htonl(INADDR_LOOPBACK);
    address.sin_port = ::htons(server_.settings().port);
    for (Descriptor& waiting : queue_) {
      waiting = Descriptor(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
      ::connect(waiting.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address);
    }
  }
  const TcpSettings& settings() const { return server_.settings(); }

 private:
  SerialServer server_;
  std::array<Descriptor, 4> queue_;
};

}  // namespace axisgate::link_test
