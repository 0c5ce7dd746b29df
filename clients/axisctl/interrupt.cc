#include "clients/axisctl/interrupt.h"

#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <string_view>

namespace axisgate::axisctl {
namespace {

std::atomic<const char*> said_on_interrupt{nullptr};

void write_error(std::string_view text) {
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
}

// Calls only functions that a signal handler may call (signal-safety(7)).
extern "C" void leave_on_interrupt(int) {
  write_error("\naxisctl: ");
  write_error(said_on_interrupt.load());
  write_error("\n");
  ::_exit(128 + SIGINT);
}

}  // namespace

void say_on_interrupt(const char* what) {
  said_on_interrupt = what;
  struct sigaction action = {};
  action.sa_handler = leave_on_interrupt;
  sigaction(SIGINT, &action, nullptr);
}

void on_end_signals(void (*handler)(int), int flags) {
  struct sigaction action = {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction at_start = {};
  sigaction(SIGHUP, nullptr, &at_start);
  if (at_start.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
}

}  // namespace axisgate::axisctl
