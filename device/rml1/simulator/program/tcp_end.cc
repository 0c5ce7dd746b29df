#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cerrno>
#include <optional>
#include <system_error>
#include <utility>

#include "device/rml1/simulator/program/host_end.h"

namespace axisgate::rml1::simulator {
namespace {

class TcpEnd : public HostEnd {
 public:
  TcpEnd(const Strand& strand, Descriptor listener, int port)
      : strand_(strand), listener_(strand, listener.release()), port_(port) {}

  std::size_t read(std::span<char> bytes) override {
    if (!client_ && !accept()) return 0;
    const ssize_t size = ::recv(client_->native_handle(), bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (size > 0) return static_cast<std::size_t>(size);
    const bool waits = size < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR);
    if (!waits) client_.reset();
    return 0;
  }

  Stream& awaited() override { return client_ ? *client_ : listener_; }
  void write(std::string_view) override {}
  bool stops_at_xoff() const override { return true; }
  bool may_change() const override { return false; }
  std::string name() const override { return fmt::format("127.0.0.1:{}", port_); }

  void close() override {
    client_.reset();
    listener_.close();
  }

 private:
  bool accept() {
    Descriptor client(::accept4(listener_.native_handle(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (client.valid()) client_.emplace(strand_, client.release());
    return client_.has_value();
  }

  Strand strand_;
  Stream listener_;
  int port_;
  std::optional<Stream> client_;
};

tl::unexpected<Problem> refuse(int port, int error) {
  return fail(Reason::link_down, fmt::format("port {}: {}", port, std::generic_category().message(error)),
              "Choose another port, or 0 for any free one.");
}

sockaddr* as_address(sockaddr_in& address) { return reinterpret_cast<sockaddr*>(&address); }

}  // namespace

Result<std::unique_ptr<HostEnd>> open_tcp_end(const Strand& strand, int port) {
  Descriptor listener(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const int on = 1;
  ::setsockopt(listener.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  socklen_t size = sizeof(address);
  if (::bind(listener.get(), as_address(address), size) != 0 || ::listen(listener.get(), SOMAXCONN) != 0 ||
      ::getsockname(listener.get(), as_address(address), &size) != 0) {
    return refuse(port, errno);
  }
  return std::make_unique<TcpEnd>(strand, std::move(listener), ntohs(address.sin_port));
}

}  // namespace axisgate::rml1::simulator
