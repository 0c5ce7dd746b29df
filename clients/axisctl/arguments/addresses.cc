#include "clients/axisctl/arguments/addresses.h"

#include <fmt/format.h>

#include <algorithm>

#include "server/config/default_socket.h"

namespace axisgate::axisctl {
namespace {

// Reports whether the target is an address in gRPC's own form, which is used unchanged.
bool has_scheme(std::string_view target) {
  constexpr std::string_view kSchemes[] = {"unix:", "unix-abstract:", "dns:", "ipv4:", "ipv6:"};
  return std::ranges::any_of(kSchemes, [&](std::string_view scheme) { return target.starts_with(scheme); });
}

bool is_path(std::string_view target) {
  return target.find('/') != std::string_view::npos || target.ends_with(".sock");
}

// Appends the port if there is none: gRPC would use port 443. Also adds the brackets that an IPv6 address needs before
// a port.
std::string with_port(std::string_view host, int port) {
  const bool bracketed = host.starts_with('[');
  const auto colons = std::ranges::count(host, ':');
  if (bracketed ? !host.ends_with(']') : colons == 1) return std::string(host);
  return !bracketed && colons > 1 ? fmt::format("[{}]:{}", host, port) : fmt::format("{}:{}", host, port);
}

}  // namespace

std::string address(std::string_view target, bool tls) {
  if (target.empty()) return "unix:" + default_socket_to_connect();
  if (has_scheme(target)) return std::string(target);
  if (is_path(target)) return fmt::format("unix:{}", target);
  return with_port(target, tls ? kNetworkPort : kGrpcPort);
}

std::string resource(const std::string& device) {
  constexpr std::string_view prefix = "devices/";
  return device.empty() || device.rfind(prefix, 0) == 0 ? device : std::string(prefix) + device;
}

}  // namespace axisgate::axisctl
