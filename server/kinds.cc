#include "server/kinds.h"

#include <array>

#include "device/rml1/kind.h"
#include "device/shrc203/kind.h"

namespace axisgate::server {

DeviceKinds device_kinds() {
  // To add a kind of stage controller, add a line here.
  static const std::array<const stage::Kind*, 1> stages = {
      &shrc203::kind(),
  };
  // To add a kind of machine that is sent jobs, add a line here.
  static const std::array<const jobs::Kind*, 1> mills = {
      &rml1::kind(),
  };
  return {.stages = stages, .mills = mills};
}

}  // namespace axisgate::server
