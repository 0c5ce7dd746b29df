// Signals: most end the gateway in order, none suspends it.
#pragma once

#include "device/link/asio.h"
#include "server/gateway.h"

namespace axisgate::server {

// Effects of signals on the daemon; server/README.md has the table. The main thread must create the object before it
// starts any other thread, so that no other thread receives a signal. Destroy it after the gateway.
class EndSignals {
 public:
  EndSignals();
  EndSignals(const EndSignals&) = delete;
  EndSignals& operator=(const EndSignals&) = delete;

  // Returns when a signal has come and the gateway is wound down, or a second request to end has come, or winding down
  // takes too long. After that, a signal that requests the end kills the process.
  void wait(Gateway& gateway);

 private:
  // Progress of the end; only advance() changes it.
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
