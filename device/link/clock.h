// The one place where device/ reads a clock.
#pragma once

#include "device/core/time.h"

namespace axisgate {

// Nanoseconds of CLOCK_BOOTTIME: never runs backwards, and continues while the host sleeps, so that a lease that nobody
// could keep alive has expired when it wakes. Thread safe.
TimePoint monotonic_now();

}  // namespace axisgate
