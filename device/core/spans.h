// Spans of time as people say them.
#pragma once

#include <string>

#include "device/core/time.h"

namespace axisgate {

// "2 h 13 min", "45 s"; whole seconds, cut off.
std::string for_people(Duration time);

}  // namespace axisgate
