#include "server/kinds.h"

#include <array>

#include "device/shrc203/kind.h"

namespace axisgate::server {

DeviceKinds device_kinds() {
  // To add a kind of stage controller, add a line here.
  static const std::array<const stage::Kind*, 1> stages = {
      &shrc203::kind(),
  };
  return {.stages = stages, .mill = "rml1"};
}

}  // namespace axisgate::server
