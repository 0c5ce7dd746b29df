// Signals: most end the gateway in order, none suspends it.
#pragma once

#include "device/link/asio.h"
#include "server/gateway.h"

namespace axisgate::server {

// What each signal does to the daemon; server/README.md has the table. Created by the main thread before it starts any
// other thread, so that none of those receives a signal. Destroyed after the gateway.
class EndSignals {
 public:
  EndSignals();
  EndSignals(const EndSignals&) = delete;
  EndSignals& operator=(const EndSignals&) = delete;

  // Returns when a signal has come and the gateway is wound down, or somebody asks a second time, or it takes too long.
  // After that, a signal that asks for the end kills the process.
  void wait(Gateway& gateway);

 private:
  // How far the end is; only advance() changes it.
  enum class Step {
    serving,
    ending,  // after SIGHUP or SIGXCPU, which nobody sent to hurry
    asked,   // after any other signal: the next one ends the daemon at once
  };

  void wait_for_next(Gateway& gateway);
  void on_signal(Gateway& gateway, int signal);
  void advance(Gateway& gateway, int signal);
  void wind_down(Gateway& gateway);

  boost::asio::io_context context_{1};
  boost::asio::signal_set signals_{context_};
  boost::asio::steady_timer limit_{context_};
  Step step_ = Step::serving;
};

}  // namespace axisgate::server
