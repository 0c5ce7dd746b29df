// Consequences of a refusal (NG): the controller may have received the line as two, and answer a second time.
#pragma once

#include <optional>

#include "device/core/time.h"

namespace axisgate::shot {

struct SecondReply {
  bool possible = false;                   // a second reply to the newest line may follow
  std::optional<TimePoint> silence_until;  // nothing is sent before this time after a refused stop
};

}  // namespace axisgate::shot
