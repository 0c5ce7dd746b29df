// What the daemon says to systemd, by sd_notify(3). Without one, nothing is said.
#pragma once

#include <optional>

#include "device/core/time.h"

namespace axisgate::server {

// Reports whether systemd, or another service manager that sets its variables, has started the daemon.
bool is_service();

void notify_ready();
void notify_alive();
// From now on the daemon may take `limit` to end, in which it does not say that it is alive.
void notify_stopping(Duration limit);

// By then it must say again that it is alive (WatchdogSec= of the service); nothing where nobody waits for that.
std::optional<Duration> watchdog_time();

}  // namespace axisgate::server
