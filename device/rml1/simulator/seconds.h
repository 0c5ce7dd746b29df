// Conversion between seconds, which the profile uses, and durations of the clock.
#pragma once

#include <chrono>
#include <cmath>

#include "device/core/time.h"

namespace axisgate::rml1::simulator {

inline double in_seconds(Duration time) { return std::chrono::duration<double>(time).count(); }

inline Duration from_seconds(double seconds) { return Duration(std::llround(seconds * 1e9)); }

}  // namespace axisgate::rml1::simulator
