#include "clients/cpp/src/target.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <climits>
#include <fstream>
#include <iterator>
#include <random>
#include <regex>

#include "axisgate/stage.h"
#include "server/config/default_socket.h"

namespace axisgate::client {
namespace {

constexpr int kPingEvery_ms = 20'000, kPingAnswer_ms = 10'000;
constexpr int kFirstReconnect_ms = 250, kLastReconnect_ms = 1000;
// Despite gRPC's name for it, this is the time limit of one connection attempt: a flooded daemon accepts late.
constexpr int kConnectLimit_ms = 5000;

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

std::string content(const std::string& path) {
  if (path.empty()) return "";
  std::ifstream file(path);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw InvalidArgument(fmt::format("{} cannot be read", path));
  return text;
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

Target to_target(const ConnectOptions& options) {
  Target target;
  target.ca = chosen(options.ca, "AXISGATE_CA");
  target.certificate = chosen(options.certificate, "AXISGATE_CERTIFICATE");
  target.key = chosen(options.key, "AXISGATE_KEY");
  target.token = chosen(options.token, "AXISGATE_TOKEN");
  target.tls = !target.ca.empty() || !target.certificate.empty();
  target.address = address(chosen(options.target, "AXISGATE_TARGET"), target.tls);
  if (target.certificate.empty() != target.key.empty()) {
    throw InvalidArgument("certificate and key must be given together");
  }
  if (!target.token.empty() && !target.tls && !is_local(target.address)) {
    throw InvalidArgument(
        fmt::format("the token is not sent unencrypted to {}: give ca, or set AXISGATE_CA", target.address));
  }
  return target;
}

std::shared_ptr<grpc::Channel> open_channel(const Target& target) {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_ENABLE_RETRIES, 0);
  arguments.SetInt(GRPC_ARG_SERVICE_CONFIG_DISABLE_RESOLUTION, 1);
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);  // a proxy would receive the token of an unencrypted call
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, kFirstReconnect_ms);
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, kLastReconnect_ms);
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, kConnectLimit_ms);
  arguments.SetInt(GRPC_ARG_CLIENT_IDLE_TIMEOUT_MS, INT_MAX);  // the connection for stops stays open
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, kPingEvery_ms);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, kPingAnswer_ms);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_PERMIT_WITHOUT_CALLS, 1);
  arguments.SetInt(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);
  const auto credentials =
      target.tls ? grpc::SslCredentials({content(target.ca), content(target.key), content(target.certificate)})
                 : grpc::InsecureChannelCredentials();
  return grpc::CreateCustomChannel(target.address, credentials, arguments);
}

void identify(const Target& target, grpc::ClientContext& context) {
  static const std::string session = new_uuid();
  context.AddMetadata("axisgate-session", session);
  if (!target.token.empty()) context.AddMetadata("authorization", "Bearer " + target.token);
}

std::string new_uuid() {
  std::random_device random;
  std::array<unsigned, 4> word;
  for (unsigned& one : word) one = random();
  // Version 4, variant 1 (RFC 9562, section 5.4).
  return fmt::format("{:08x}-{:04x}-4{:03x}-{:04x}-{:04x}{:08x}", word[0], word[1] >> 16, word[1] & 0xfffU,
                     (word[2] >> 16 & 0x3fffU) | 0x8000U, word[2] & 0xffffU, word[3]);
}

}  // namespace axisgate::client
