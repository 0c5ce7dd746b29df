// The one place where device/ reads a clock.
#pragma once

#include "device/core/time.h"

namespace axisgate {

// Nanoseconds of CLOCK_MONOTONIC; never runs backwards. Thread safe.
TimePoint monotonic_now();

}  // namespace axisgate
