#include "server/service_manager.h"

#include <fmt/format.h>
#include <systemd/sd-daemon.h>

#include <chrono>
#include <cstdint>
#include <cstdlib>

namespace axisgate::server {
namespace {

// Keeps systemd's variables in the environment: every notification reads them.
constexpr int kKeepVariables = 0;

}  // namespace

bool is_service() { return std::getenv("NOTIFY_SOCKET") != nullptr || std::getenv("INVOCATION_ID") != nullptr; }

void notify_ready() { ::sd_notify(kKeepVariables, "READY=1"); }

void notify_alive() { ::sd_notify(kKeepVariables, "WATCHDOG=1"); }

void notify_stopping(Duration limit) {
  const auto microseconds = std::chrono::duration_cast<std::chrono::microseconds>(limit).count();
  const std::string state = fmt::format("STOPPING=1\nWATCHDOG_USEC={}", microseconds);
  ::sd_notify(kKeepVariables, state.c_str());
}

std::optional<Duration> watchdog_time() {
  std::uint64_t microseconds = 0;
  if (::sd_watchdog_enabled(kKeepVariables, &microseconds) <= 0) return std::nullopt;
  return std::chrono::microseconds(static_cast<std::int64_t>(microseconds));
}

}  // namespace axisgate::server
