#include "server/end_signals.h"

#include <fmt/format.h>
#include <pthread.h>
#include <string.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <string>
#include <vector>

#include "server/limits.h"
#include "server/log.h"
#include "server/service_manager.h"

namespace axisgate::server {
namespace {

// Signals that would kill the process although it has no fault. ending_signals() adds the real-time signals.
constexpr int kEnding[] = {SIGINT,  SIGTERM,   SIGHUP,  SIGQUIT, SIGUSR1, SIGUSR2,  SIGALRM,
                           SIGXCPU, SIGVTALRM, SIGPROF, SIGPOLL, SIGPWR,  SIGSTKFLT};

// A failed write reports its error itself (SIGPIPE, SIGXFSZ). A background job that uses its terminal would be
// suspended (SIGTTIN, SIGTTOU).
constexpr int kIgnored[] = {SIGPIPE, SIGXFSZ, SIGTTIN, SIGTTOU};

// Signals that may come more than once although nobody sends them twice. When a terminal is closed, its shell sends
// SIGHUP to its jobs, and the kernel sends another when the shell has ended. SIGXCPU comes again with each further
// second of processor time.
constexpr int kRepeated[] = {SIGHUP, SIGXCPU};

bool is_repeated(int signal) {
  return std::find(std::begin(kRepeated), std::end(kRepeated), signal) != std::end(kRepeated);
}

// Reports whether nohup(1), or another program that started the daemon, has made it ignore the signal.
bool is_ignored(int signal) {
  struct sigaction action {};
  return ::sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

void ignore(int signal) { std::signal(signal, SIG_IGN); }

std::vector<int> ending_signals() {
  std::vector<int> signals(std::begin(kEnding), std::end(kEnding));
  for (int signal = SIGRTMIN; signal <= SIGRTMAX; ++signal) signals.push_back(signal);
  return signals;
}

void change_mask(int how) {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : ending_signals()) sigaddset(&signals, signal);
  sigaddset(&signals, SIGTSTP);
  pthread_sigmask(how, &signals, nullptr);
}

std::string name_of(int signal) {
  const char* const name = ::sigabbrev_np(signal);
  return name != nullptr ? fmt::format("SIG{}", name) : fmt::format("SIGRTMIN+{}", signal - SIGRTMIN);
}

}  // namespace

EndSignals::EndSignals() {
  change_mask(SIG_BLOCK);
  for (const int signal : kIgnored) ignore(signal);
  for (const int signal : ending_signals()) {
    if (signal != SIGHUP || !is_ignored(SIGHUP)) signals_.add(signal);
  }
  signals_.add(SIGTSTP);
}

void EndSignals::wait(Gateway& gateway) {
  wait_for_next(gateway);
  change_mask(SIG_UNBLOCK);
  context_.run();
  change_mask(SIG_BLOCK);
  signals_.clear();
  for (const int signal : kRepeated) ignore(signal);
  ignore(SIGTSTP);
  change_mask(SIG_UNBLOCK);
}

void EndSignals::wait_for_next(Gateway& gateway) {
  signals_.async_wait([this, &gateway](const boost::system::error_code&, int signal) {
    on_signal(gateway, signal);
    wait_for_next(gateway);
  });
}

void EndSignals::on_signal(Gateway& gateway, int signal) {
  if (signal == SIGTSTP) {
    log::warn(
        "SIGTSTP (Ctrl-Z) is ignored: a suspended daemon could not stop what moves (to end the daemon, press Ctrl-C or "
        "send SIGTERM)");
  } else if (signal == SIGHUP && is_service()) {
    log::warn(
        "SIGHUP is ignored: a service has no terminal, and there is nothing to reload (to apply a changed "
        "configuration, restart the service)");
  } else {
    advance(gateway, signal);
  }
}

void EndSignals::advance(Gateway& gateway, int signal) {
  const bool asks = !is_repeated(signal);
  if (step_ == Step::asked && asks) {
    log::warn("ending at once: {} asks again; what moves may continue to move", name_of(signal));
    return context_.stop();
  }
  log::info("{}: {}{}", step_ == Step::serving ? "ending" : "already ending", name_of(signal),
            asks ? "; a second signal ends at once" : "");
  log::flush();
  if (step_ == Step::serving) wind_down(gateway);
  if (step_ != Step::asked) step_ = asks ? Step::asked : Step::ending;
}

void EndSignals::wind_down(Gateway& gateway) {
  notify_stopping(gateway.wind_down_limit() + kRestOfTheEnd);
  gateway.wind_down([this] { context_.stop(); });
  limit_.expires_after(gateway.wind_down_limit());
  limit_.async_wait([this](const boost::system::error_code&) {
    log::warn("ending although a line has not been closed: what moves may continue to move");
    context_.stop();
  });
}

}  // namespace axisgate::server
