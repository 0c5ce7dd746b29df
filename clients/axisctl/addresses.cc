#include "clients/axisctl/addresses.h"

#include <string_view>

#include "server/config/default_socket.h"

namespace axisgate::axisctl {

std::string address(std::string target) {
  if (target.empty()) target = default_socket_to_connect();
  return target.front() == '/' ? "unix:" + target : target;
}

std::string resource(const std::string& device) {
  constexpr std::string_view prefix = "devices/";
  return device.empty() || device.rfind(prefix, 0) == 0 ? device : std::string(prefix) + device;
}

}  // namespace axisgate::axisctl
