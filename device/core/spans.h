// Durations as text for people.
#pragma once

#include <string>

#include "device/core/time.h"

namespace axisgate {

// Returns a text such as "2 h 13 min" or "45 s". Fractions are cut off.
std::string for_people(Duration time);

}  // namespace axisgate
