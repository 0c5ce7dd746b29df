// Limits a log line that an outside event could cause a thousand times a second to one in ten seconds.
#pragma once

#include <chrono>
#include <optional>

#include "device/link/clock.h"
#include "server/limits.h"

namespace axisgate::server {

class Seldom {
 public:
  // Reports whether the last true result is at least 10 s ago.
  bool due() {
    const TimePoint now = monotonic_now();
    if (last_ && now - *last_ < kSeldomPause) return false;
    last_ = now;
    return true;
  }

 private:
  std::optional<TimePoint> last_;
};

}  // namespace axisgate::server
