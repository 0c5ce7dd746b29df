// The only place in which device/ reads a clock.
#pragma once

#include "device/core/time.h"

namespace axisgate {

// Returns the time in nanoseconds of CLOCK_BOOTTIME. It never decreases, and it continues while the host sleeps, so
// that a lease that could not be renewed has expired when the host wakes. Thread safe.
TimePoint monotonic_now();

}  // namespace axisgate
