// The daemon's listening sockets, and the thread that accepts connections.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "device/core/problem.h"
#include "device/link/asio.h"
#include "server/config/config.h"
#include "server/connections/acceptor.h"
#include "server/connections/endpoints.h"

namespace axisgate::server {

// A Listener has its own thread, so that neither lines nor readers delay the connection of a stop.
class Listener {
 public:
  // Listens at all addresses; clients wait to be accepted until start(). Fails if another process serves an address, or
  // if the socket's directory cannot be trusted.
  static Result<std::unique_ptr<Listener>> open(TcpAddress address, const std::string& socket,
                                                std::optional<TcpAddress> network);
  // Calls stop() and removes the socket's file.
  ~Listener();

  // Passes connections to `on_connection` on the listener's thread. Call it once.
  void start(ConnectionLimits limits, Acceptor::OnConnection on_connection);
  // Stops accepting connections; strand() continues to run.
  void stop_accepting();
  // After this, nothing runs on strand().
  void stop();

  // Strand of the listener's thread.
  Strand strand() const { return strand_; }

  const TcpAddress& address() const { return address_; }  // with the port actually taken
  const std::string& socket() const { return unix_.path(); }
  const std::optional<TcpAddress>& network() const { return network_; }
  ConnectionCounts counts() { return acceptor_->counts(); }  // after start(); thread safe

 private:
  Listener(TcpAddress address, Descriptor tcp, UnixListener unix_socket);

  const TcpAddress address_;
  std::optional<TcpAddress> network_;
  Descriptor tcp_;
  Descriptor network_socket_;  // invalid without network_
  UnixListener unix_;
  boost::asio::io_context context_{1};
  const Strand strand_{context_.get_executor()};
  std::unique_ptr<Acceptor> acceptor_;
  std::thread thread_;
};

}  // namespace axisgate::server
