#include "server/connections/listener.h"

#include <utility>

namespace axisgate::server {

Listener::Listener(TcpAddress address, Descriptor tcp, UnixListener unix_socket)
    : address_(std::move(address)), tcp_(std::move(tcp)), unix_(std::move(unix_socket)) {}

Result<std::unique_ptr<Listener>> Listener::open(TcpAddress address, const std::string& socket,
                                                 std::optional<TcpAddress> network) {
  Result<Descriptor> tcp = listen_on(address);
  if (!tcp) return tl::unexpected(tcp.error());
  Result<UnixListener> unix_socket = UnixListener::open(socket);
  if (!unix_socket) return tl::unexpected(unix_socket.error());
  std::unique_ptr<Listener> listener(new Listener(std::move(address), *std::move(tcp), *std::move(unix_socket)));
  if (network) {
    Result<Descriptor> socket_there = listen_on(*network);
    if (!socket_there) return tl::unexpected(socket_there.error());
    listener->network_ = std::move(network);
    listener->network_socket_ = *std::move(socket_there);
  }
  return listener;
}

Listener::~Listener() { stop(); }

void Listener::stop() {
  context_.stop();
  if (thread_.joinable()) thread_.join();
}

void Listener::start(ConnectionLimits limits, Acceptor::OnConnection on_connection) {
  acceptor_ = std::make_unique<Acceptor>(strand_, limits, std::move(on_connection));
  acceptor_->listen(std::move(tcp_));
  acceptor_->listen(unix_.take_socket());
  if (network_) acceptor_->listen(std::move(network_socket_), Acceptor::Origin::network);
  thread_ = std::thread([this] { context_.run(); });
}

void Listener::stop_accepting() {
  boost::asio::post(strand_, [this] { acceptor_->close(); });
}

}  // namespace axisgate::server
