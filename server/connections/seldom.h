// Keeps a log line that something outside could cause a thousand times a second to one in ten seconds.
#pragma once

#include <chrono>
#include <optional>

#include "device/link/clock.h"

namespace axisgate::server {

class Seldom {
 public:
  // Whether the last time that it was is long enough ago.
  bool due() {
    const TimePoint now = monotonic_now();
    if (last_ && now - *last_ < kApart) return false;
    last_ = now;
    return true;
  }

 private:
  static constexpr Duration kApart = std::chrono::seconds(10);
  std::optional<TimePoint> last_;
};

}  // namespace axisgate::server
