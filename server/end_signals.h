// SIGINT and SIGTERM: the first ends the gateway in order, the second at once.
#pragma once

#include "device/link/asio.h"
#include "server/gateway.h"

namespace axisgate::server {

// Created by the main thread before it starts any other thread, so that none of those receives these signals. Destroyed
// after the gateway. After that, a signal ends the process as it would any other.
class EndSignals {
 public:
  EndSignals();
  EndSignals(const EndSignals&) = delete;
  EndSignals& operator=(const EndSignals&) = delete;

  // Returns when a signal has come and the gateway is wound down, or a second signal came, or it takes too long.
  void wait(Gateway& gateway);

 private:
  void on_first(Gateway& gateway, int signal);

  boost::asio::io_context context_{1};
  boost::asio::signal_set signals_{context_};
  boost::asio::steady_timer limit_{context_};
};

}  // namespace axisgate::server
