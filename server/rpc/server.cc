#include "server/rpc/server.h"

#include <fmt/format.h>
#include <grpc/support/log.h>
#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <initializer_list>
#include <utility>
#include <vector>

#include "server/api/api.h"
#include "server/connections/callers.h"
#include "server/connections/listener.h"
#include "server/metrics/connection_metrics.h"
#include "server/rpc/access_service.h"
#include "server/rpc/call_limits.h"
#include "server/rpc/command_service.h"
#include "server/rpc/control_service.h"
#include "server/rpc/device_service.h"
#include "server/rpc/diagnostics_service.h"
#include "server/rpc/endpoints.h"
#include "server/rpc/event_service.h"
#include "server/rpc/half_close.h"
#include "server/rpc/health_service.h"
#include "server/rpc/network_credentials.h"
#include "server/rpc/position_service.h"
#include "server/rpc/rpc_metrics.h"
#include "server/rpc/setting_service.h"
#include "server/rpc/simulator_service.h"
#include "server/rpc/stage_service.h"
#include "server/rpc/stop_only.h"

namespace axisgate::rpc {
namespace {

constexpr auto kShutdownWait = std::chrono::milliseconds(500);

// How many users on the Unix socket are distinguished.
constexpr std::size_t kCallerSlots = 32;

// A connection on which nobody speaks HTTP/2 does not hold its place for gRPC's two minutes.
constexpr int kSilentMs = 20'000;
// In the reserve a client that was refused soon makes room, and finds an ordinary place when it connects again. A stop
// under way is waited for.
constexpr int kReserveIdleMs = 1'000;
constexpr int kReserveAgeMs = 2'000;
constexpr int kReserveGraceMs = 30'000;

// gRPC's own lines tell nothing that ours do not, and would stand among them unasked.
void log_quietly(gpr_log_func_args* line) { spdlog::debug("gRPC: {}", line->message); }

}  // namespace

class Server::Services {
 public:
  Services(server::Gateway& gateway, server::Access& access, server::SavedPositions& positions,
           std::unique_ptr<server::Listener> listener);
  ~Services();

  // Takes connections from now on. internal: gRPC does not start.
  Result<void> serve(server::Gateway& gateway, const server::ConnectionLimits& limits);
  server::Listener& listener() { return *listener_; }

 private:
  // A gRPC server and the ways into it.
  struct Part {
    std::unique_ptr<grpc::Server> server;
    std::optional<Endpoints> endpoints;
  };

  void build_ordinary();
  void build_reserve();
  void build(grpc::ServerBuilder& builder, Part& part);

  api::Api api_;
  const HalfClose half_close_;
  const std::optional<server::NetworkConfig> network_;
  const int message_bytes_max_;
  std::unique_ptr<server::Listener> listener_;
  std::optional<server::ConnectionMetrics> connection_metrics_;  // none before the listener has started
  RpcMetrics rpc_metrics_;
  server::CallerSlots callers_;
  DeviceService devices_;
  StageService stage_;
  EventService events_;
  CommandService commands_;
  SettingService settings_;
  SimulatorService simulators_;
  PositionService positions_;
  DiagnosticsService diagnostics_;
  ControlService control_;
  AccessService known_callers_;
  HealthService health_;
  StopService stops_;
  NamesService names_;
  RefusingService refusing_;
  // Two, since how long a connection may be idle is a matter of the whole server.
  Part ordinary_;
  Part reserve_;
};

Server::Services::Services(server::Gateway& gateway, server::Access& access, server::SavedPositions& positions,
                           std::unique_ptr<server::Listener> listener)
    : api_(gateway, access, positions),
      half_close_(gateway),
      network_(gateway.config().network),
      message_bytes_max_(gateway.config().limits.message_bytes),
      listener_(std::move(listener)),
      rpc_metrics_(*gateway.metrics().registry()),
      callers_(kCallerSlots),
      devices_(api_.devices),
      stage_(api_.stops, api_.motions, api_.paths, api_.jogs, half_close_),
      events_(api_.events),
      commands_(api_.commands),
      settings_(api_.settings),
      simulators_(api_.simulators),
      positions_(api_.positions),
      diagnostics_(api_.diagnostics),
      control_(api_.leases),
      known_callers_(api_.tokens),
      health_(api_.streams),
      stops_(stage_),
      names_(devices_) {}

Result<void> Server::Services::serve(server::Gateway& gateway, const server::ConnectionLimits& limits) {
  build_ordinary();
  build_reserve();
  if (ordinary_.server == nullptr || reserve_.server == nullptr) {
    return fail(Reason::internal, "gRPC does not start", "SPDLOG_LEVEL=debug shows what it says about it");
  }
  listener_->start(limits,
                   [this](Descriptor connection, server::Acceptor::Service service, server::Acceptor::Origin origin) {
                     const std::optional<uid_t> user = server::peer_uid(connection.get());
                     const auto slot = user ? std::optional(callers_.slot_of(*user)) : std::nullopt;
                     Part& part = service == server::Acceptor::Service::all ? ordinary_ : reserve_;
                     part.endpoints->enter(std::move(connection), origin, slot);
                   });
  connection_metrics_.emplace(gateway.metrics(), [this] { return listener_->counts(); });
  return {};
}

void Server::Services::build_ordinary() {
  grpc::reflection::InitProtoReflectionServerBuilderPlugin();
  grpc::ServerBuilder builder;
  builder.AddChannelArgument(GRPC_ARG_SERVER_HANDSHAKE_TIMEOUT_MS, kSilentMs);
  for (grpc::Service* service :
       std::initializer_list<grpc::Service*>{&devices_, &stage_, &events_, &commands_, &settings_, &simulators_,
                                             &positions_, &diagnostics_, &control_, &known_callers_, &health_}) {
    builder.RegisterService(service);
  }
  build(builder, ordinary_);
}

void Server::Services::build_reserve() {
  grpc::ServerBuilder builder;
  builder.AddChannelArgument(GRPC_ARG_SERVER_HANDSHAKE_TIMEOUT_MS, kReserveAgeMs);
  builder.AddChannelArgument(GRPC_ARG_MAX_CONNECTION_IDLE_MS, kReserveIdleMs);
  builder.AddChannelArgument(GRPC_ARG_MAX_CONNECTION_AGE_MS, kReserveAgeMs);
  builder.AddChannelArgument(GRPC_ARG_MAX_CONNECTION_AGE_GRACE_MS, kReserveGraceMs);
  builder.RegisterService(&stops_);
  builder.RegisterService(&names_);
  builder.RegisterCallbackGenericService(&refusing_);
  build(builder, reserve_);
}

// What both have in common.
void Server::Services::build(grpc::ServerBuilder& builder, Part& part) {
  std::vector<std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface>> interceptors;
  interceptors.push_back(rpc_metrics_.interceptor());
  interceptors.push_back(counting_interceptor(api_.admission));
  builder.experimental().SetInterceptorCreators(std::move(interceptors));
  builder.SetMaxReceiveMessageSize(message_bytes_max_);
  part.endpoints.emplace(builder, callers_, Gate{api_.admission, rpc_metrics_}, network_);
  part.server = builder.BuildAndStart();
}

Server::Services::~Services() {
  connection_metrics_.reset();
  // gRPC would not close what is still handed to it.
  listener_.reset();
  const auto deadline = std::chrono::system_clock::now() + kShutdownWait;
  for (const Part* part : {&ordinary_, &reserve_}) {
    if (part->server != nullptr) part->server->Shutdown(deadline);
  }
  for (const Part* part : {&ordinary_, &reserve_}) {
    if (part->server != nullptr) part->server->Wait();
  }
}

Server::Server(std::unique_ptr<Services> services) : services_(std::move(services)) {}

Server::~Server() = default;

Result<std::unique_ptr<Server>> Server::start(server::Gateway& gateway, server::Access& access,
                                              server::SavedPositions& positions,
                                              const server::ConnectionLimits& limits) {
  gpr_set_log_function(log_quietly);
  const server::Config& config = gateway.config();
  const auto network = config.network ? std::optional(config.network->listen) : std::nullopt;
  auto listener = server::Listener::open(config.listen, config.socket, network);
  if (!listener) return tl::unexpected(listener.error());
  allow_only_tls_13();
  auto services = std::make_unique<Services>(gateway, access, positions, *std::move(listener));
  if (const auto serving = services->serve(gateway, limits); !serving) return tl::unexpected(serving.error());
  return std::unique_ptr<Server>(new Server(std::move(services)));
}

const server::TcpAddress& Server::listen() const { return services_->listener().address(); }

const std::string& Server::socket() const { return services_->listener().socket(); }

const std::optional<server::TcpAddress>& Server::network() const { return services_->listener().network(); }

server::ConnectionCounts Server::connections() { return services_->listener().counts(); }

}  // namespace axisgate::rpc
