#include "clients/axisctl/arguments/addresses.h"

namespace axisgate::axisctl {

std::string resource(const std::string& device) {
  constexpr std::string_view prefix = "devices/";
  return device.empty() || device.rfind(prefix, 0) == 0 ? device : std::string(prefix) + device;
}

}  // namespace axisgate::axisctl
