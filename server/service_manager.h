// Notifications to systemd by sd_notify(3). Without systemd, the functions do nothing.
#pragma once

#include <optional>

#include "device/core/time.h"

namespace axisgate::server {

// Reports whether systemd, or another service manager that sets its variables, has started the daemon.
bool is_service();

void notify_ready();
void notify_alive();
// Reports that the daemon is ending and may send no further signs of life for `limit`.
void notify_stopping(Duration limit);

// Longest time between two signs of life (WatchdogSec= of the service); nullopt if the service manager expects none.
std::optional<Duration> watchdog_time();

}  // namespace axisgate::server
