#include "server/kinds.h"

#include <array>

#include "device/shrc203/kind.h"

namespace axisgate::server {

// A new kind is one line here.
DeviceKinds device_kinds() {
  static const std::array<const stage::Kind*, 1> kinds = {
      &shrc203::kind(),
  };
  return kinds;
}

}  // namespace axisgate::server
