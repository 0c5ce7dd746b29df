// Where the daemon listens, and the thread that accepts there.
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

// A thread of its own, so that neither lines nor readers make a stop wait for its connection.
class Listener {
 public:
  // Listens at all of them; clients wait to be accepted until start(). Refuses an address that somebody else serves,
  // and a socket whose directory cannot be trusted.
  static Result<std::unique_ptr<Listener>> open(TcpAddress address, const std::string& socket,
                                                std::optional<TcpAddress> network);
  // stop(), and the socket's file is gone.
  ~Listener();

  // Hands connections over, on its thread. Call it once.
  void start(ConnectionLimits limits, Acceptor::OnConnection on_connection);
  // From now on nobody is accepted; what is on strand() continues.
  void stop_accepting();
  // Nothing runs on strand() any more.
  void stop();

  // Of its thread.
  Strand strand() const { return strand_; }

  const TcpAddress& address() const { return address_; }  // with the port really taken
  const std::string& socket() const { return unix_.path(); }
  const std::optional<TcpAddress>& network() const { return network_; }
  ConnectionCounts counts() { return acceptor_->counts(); }  // after start(), from any thread

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
