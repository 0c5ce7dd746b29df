// Configuration of one controller of the family, checked before the daemon starts.
#pragma once

#include "device/stage/profile.h"

namespace axisgate::shot {

// Priority of a running path's refills on its line. `reserved`: they go before everything but stops, and the line is
// kept free when they are due. The others only show why this is needed: no configuration names them.
enum class Refills { reserved, first, among_questions };

struct Profile : stage::Profile {
  Refills refills = Refills::reserved;
};

}  // namespace axisgate::shot
