#include "device/link/clock.h"

#include <chrono>

namespace axisgate {

TimePoint monotonic_now() {
  return TimePoint(std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch()));
}

}  // namespace axisgate
