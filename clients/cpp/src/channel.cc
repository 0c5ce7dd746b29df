#include "clients/cpp/src/channel.h"

#include <fmt/format.h>

#include <climits>
#include <fstream>
#include <iterator>
#include <string>

#include "axisgate/errors.h"
#include "clients/cpp/src/identity.h"

namespace axisgate::client {
namespace {

constexpr int kPingEvery_ms = 20'000, kPingAnswer_ms = 10'000;
constexpr int kFirstReconnect_ms = 250, kLastReconnect_ms = 1000;
// Despite gRPC's name for it, this is the time limit of one connection attempt: a flooded daemon accepts late.
constexpr int kConnectLimit_ms = 5000;

std::string content(const std::string& path) {
  if (path.empty()) return "";
  std::ifstream file(path);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw InvalidArgument(fmt::format("{} cannot be read", path));
  return text;
}

}  // namespace

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
  return grpc::experimental::CreateCustomChannelWithInterceptors(target.address, credentials, arguments,
                                                                 identifying(target.token));
}

}  // namespace axisgate::client
