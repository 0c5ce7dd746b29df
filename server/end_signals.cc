#include "server/end_signals.h"

#include <pthread.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <csignal>

#include "server/service_manager.h"

namespace axisgate::server {
namespace {

// For streams and threads, after the devices.
constexpr Duration kRestOfTheEnd = std::chrono::seconds(5);

void change_mask(int how) {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(how, &signals, nullptr);
}

}  // namespace

EndSignals::EndSignals() {
  change_mask(SIG_BLOCK);
  signals_.add(SIGINT);
  signals_.add(SIGTERM);
}

void EndSignals::wait(Gateway& gateway) {
  change_mask(SIG_UNBLOCK);
  signals_.async_wait([&](const boost::system::error_code&, int signal) { on_first(gateway, signal); });
  context_.run();
  signals_.clear();
}

void EndSignals::on_first(Gateway& gateway, int signal) {
  spdlog::info("ending: {}; a second signal ends at once", signal == SIGINT ? "SIGINT" : "SIGTERM");
  spdlog::default_logger()->flush();
  notify_stopping(gateway.wind_down_limit() + kRestOfTheEnd);
  gateway.wind_down([this] { context_.stop(); });
  signals_.async_wait([this](const boost::system::error_code&, int) {
    spdlog::warn("ending at once, asked twice: what moves may go on moving");
    context_.stop();
  });
  limit_.expires_after(gateway.wind_down_limit());
  limit_.async_wait([this](const boost::system::error_code&) {
    spdlog::warn("ending although a line has not been closed: what moves may go on moving");
    context_.stop();
  });
}

}  // namespace axisgate::server
