#include "clients/cpp/src/target.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <regex>

#include "axisgate/stage.h"
#include "server/config/default_socket.h"

namespace axisgate::client {
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

std::string chosen(const std::string& option, const char* variable) {
  return option.empty() ? environment(variable) : option;
}

}  // namespace

std::string address(std::string_view target, bool tls) {
  if (target.empty()) return "unix:" + default_socket_to_connect();
  if (has_scheme(target)) return std::string(target);
  if (is_path(target)) return fmt::format("unix:{}", target);
  return with_port(target, tls ? kNetworkPort : kGrpcPort);
}

bool is_local(std::string_view address) {
  static const std::regex loopback(R"((ipv[46]:|dns:/*)?(localhost|127\.[0-9.]+|\[::1\]|::1)(:[0-9]+)?)");
  return address.starts_with("unix") || std::regex_match(address.begin(), address.end(), loopback);
}

void check(const Target& target) {
  if (target.certificate.empty() != target.key.empty()) {
    throw InvalidArgument("certificate and key must be given together");
  }
  if (!target.token.empty() && !target.tls && !is_local(target.address)) {
    throw InvalidArgument(
        fmt::format("the token is not sent unencrypted to {}: give ca, or set AXISGATE_CA", target.address));
  }
}

Target to_target(const ConnectOptions& options) {
  Target target;
  target.ca = chosen(options.ca, "AXISGATE_CA");
  target.certificate = chosen(options.certificate, "AXISGATE_CERTIFICATE");
  target.key = chosen(options.key, "AXISGATE_KEY");
  target.token = chosen(options.token, "AXISGATE_TOKEN");
  target.tls = !target.ca.empty() || !target.certificate.empty();
  target.address = address(chosen(options.target, "AXISGATE_TARGET"), target.tls);
  check(target);
  return target;
}

}  // namespace axisgate::client
