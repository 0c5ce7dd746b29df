#include "server/rpc/server.h"

#include <fmt/format.h>
#include <grpc/health/v1/health.grpc.pb.h>
#include <grpc/support/log.h>
#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>

#include <atomic>
#include <chrono>
#include <future>
#include <initializer_list>
#include <utility>
#include <vector>

#include "server/api/api.h"
#include "server/connections/listener.h"
#include "server/front/front.h"
#include "server/log.h"
#include "server/metrics/connection_metrics.h"
#include "server/rpc/calls/half_close.h"
#include "server/rpc/calls/queue_waker.h"
#include "server/rpc/calls/unreadable.h"
#include "server/rpc/gate/call_filter.h"
#include "server/rpc/gate/refusals.h"
#include "server/rpc/gate/rpc_metrics.h"
#include "server/rpc/services/access_service.h"
#include "server/rpc/services/command_service.h"
#include "server/rpc/services/control_service.h"
#include "server/rpc/services/device_service.h"
#include "server/rpc/services/diagnostics_service.h"
#include "server/rpc/services/event_service.h"
#include "server/rpc/services/health_service.h"
#include "server/rpc/services/history_service.h"
#include "server/rpc/services/mill_service.h"
#include "server/rpc/services/position_service.h"
#include "server/rpc/services/setting_service.h"
#include "server/rpc/services/simulator_service.h"
#include "server/rpc/services/stage_service.h"

namespace axisgate::rpc {
namespace {

constexpr auto kShutdownWait = std::chrono::milliseconds(500);

// gRPC's log lines add no information to the daemon's, so they are logged at debug level only.
void log_quietly(gpr_log_func_args* line) { server::log::debug("gRPC: {}", line->message); }

}  // namespace

class Server::Services {
 public:
  Services(server::Gateway& gateway, server::Access& access, server::SavedPositions& positions,
           std::unique_ptr<server::Listener> listener);
  ~Services();

  // Starts to take connections. Fails with internal if gRPC does not start.
  Result<void> serve(server::Gateway& gateway, const server::ConnectionLimits& limits);
  server::Listener& listener() { return *listener_; }
  std::vector<server::Watchdog::Thread> threads();

 private:
  void build();
  void enter(Descriptor connection);
  void on_the_front(std::function<void(const std::function<void()>& done)> act);

  api::Api api_;
  const HalfClose half_close_;
  const int message_bytes_max_;
  std::unique_ptr<server::Listener> listener_;
  std::optional<server::ConnectionMetrics> connection_metrics_;  // none before the listener has started
  RpcMetrics rpc_metrics_;
  Refusals refusals_;
  CallFilter filter_;
  DeviceService devices_;
  StageService stage_;
  EventService events_;
  HistoryService history_;
  CommandService commands_;
  SettingService settings_;
  SimulatorService simulators_;
  PositionService positions_;
  MillService mills_;
  DiagnosticsService diagnostics_;
  ControlService control_;
  AccessService known_callers_;
  HealthService health_;
  std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> acceptor_;
  std::unique_ptr<grpc::Server> grpc_;
  std::shared_ptr<grpc::health::v1::Health::Stub> itself_;  // a client within this process
  std::optional<QueueWaker> waker_;                         // none before gRPC has started
  front::Front front_;
  std::atomic<bool> ending_ = false;
};

Server::Services::Services(server::Gateway& gateway, server::Access& access, server::SavedPositions& positions,
                           std::unique_ptr<server::Listener> listener)
    : api_(gateway, access, positions),
      half_close_(gateway),
      message_bytes_max_(gateway.config().limits.message_bytes),
      listener_(std::move(listener)),
      rpc_metrics_(*gateway.metrics().registry()),
      refusals_(
          *gateway.metrics().registry(),
          [&gateway](Duration wait, std::function<void()> task) { gateway.timeouts().after(wait, std::move(task)); }),
      filter_(api_, rpc_metrics_, refusals_),
      devices_(api_.devices),
      stage_(api_.motions, api_.paths, api_.jogs, half_close_),
      events_(api_.events),
      history_(api_.history, gateway),
      commands_(api_.commands),
      settings_(api_.settings),
      simulators_(api_.simulators),
      positions_(api_.positions),
      mills_(api_.mill, half_close_),
      diagnostics_(api_.diagnostics),
      control_(api_.leases),
      known_callers_(api_.tokens),
      health_(api_.streams),
      front_(
          listener_->strand(), filter_, gateway.config().network,
          [this](Descriptor connection) { enter(std::move(connection)); },
          [this](const front::Peer& peer, const front::Closing& closing) { refusals_.note(peer, closing); },
          {.message_bytes = static_cast<std::size_t>(message_bytes_max_)}) {}

Result<void> Server::Services::serve(server::Gateway& gateway, const server::ConnectionLimits& limits) {
  build();
  if (grpc_ == nullptr) {
    return fail(Reason::internal, "gRPC does not start", "SPDLOG_LEVEL=debug shows what it says about it");
  }
  const auto itself = grpc_->InProcessChannel({});
  itself_ = grpc::health::v1::Health::NewStub(itself);
  waker_.emplace(itself, gateway.timeouts());
  listener_->start(limits,
                   [this](Descriptor connection, server::Acceptor::Service service, server::Acceptor::Origin origin) {
                     front_.enter(std::move(connection), service, origin);
                   });
  connection_metrics_.emplace(gateway.metrics(), [this] { return listener_->counts(); });
  return {};
}

void Server::Services::build() {
  grpc::reflection::InitProtoReflectionServerBuilderPlugin();
  grpc::ServerBuilder builder;
  // gRPC would otherwise estimate the bandwidth and raise the length of frames, which the front bounds.
  builder.AddChannelArgument(GRPC_ARG_HTTP2_BDP_PROBE, 0);
  for (grpc::Service* service : std::initializer_list<grpc::Service*>{
           &devices_, &stage_, &events_, &history_, &commands_, &settings_, &simulators_, &positions_, &mills_,
           &diagnostics_, &control_, &known_callers_, &health_}) {
    builder.RegisterService(service);
  }
  std::vector<std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface>> interceptors;
  interceptors.push_back(unreadable_interceptor());
  interceptors.push_back(refusals_.interceptor());
  interceptors.push_back(rpc_metrics_.interceptor());
  builder.experimental().SetInterceptorCreators(std::move(interceptors));
  builder.SetMaxReceiveMessageSize(message_bytes_max_);
  // The front bounds metadata.
  constexpr int kMetadataBytes = 64 << 10;
  builder.AddChannelArgument(GRPC_ARG_MAX_METADATA_SIZE, kMetadataBytes);
  using Type = grpc::ServerBuilder::experimental_type::ExternalConnectionType;
  // The front identifies and authorizes the caller.
  acceptor_ = builder.experimental().AddExternalConnectionAcceptor(Type::FROM_FD, grpc::InsecureServerCredentials());
  grpc_ = builder.BuildAndStart();
}

// gRPC's threads answer when a call that the daemon makes to itself has passed through them.
std::vector<server::Watchdog::Thread> Server::Services::threads() {
  const auto ask_listener = [strand = listener_->strand()](std::function<void()> answer) {
    boost::asio::post(strand, std::move(answer));
  };
  const auto ask_grpc = [itself = itself_](std::function<void()> answer) {
    struct Call {
      grpc::ClientContext context;
      grpc::health::v1::HealthCheckRequest request;
      grpc::health::v1::HealthCheckResponse response;
    };
    const auto call = std::make_shared<Call>();
    itself->async()->Check(&call->context, &call->request, &call->response,
                           [call, answer = std::move(answer)](const grpc::Status& status) {
                             if (status.ok()) answer();
                           });
  };
  return {{"the thread of the listener", ask_listener}, {"gRPC", ask_grpc}};
}

void Server::Services::enter(Descriptor connection) {
  // gRPC would not close a connection that is handed over now.
  if (ending_) return;
  grpc::experimental::ExternalConnectionAcceptor::NewConnectionParameters parameters;
  parameters.fd = connection.release();
  acceptor_->HandleNewConnection(&parameters);
}

Server::Services::~Services() {
  connection_metrics_.reset();
  waker_.reset();
  ending_ = true;
  listener_->stop_accepting();
  on_the_front([this](const std::function<void()>& done) {
    front_.announce_end();
    done();
  });
  api_.streams.end_all();
  if (grpc_ != nullptr) {
    grpc_->Shutdown(std::chrono::system_clock::now() + kShutdownWait);
    grpc_->Wait();
    // The ends of streams may still be in the front's buffers.
    on_the_front([this](const std::function<void()>& done) { front_.when_grpc_has_left(done); });
  }
  listener_->stop();
}

// Runs `act` on the front's strand and waits until `act` has called `done`, at most kShutdownWait: a client that does
// not read must not delay the end.
void Server::Services::on_the_front(std::function<void(const std::function<void()>& done)> act) {
  const auto acted = std::make_shared<std::promise<void>>();
  boost::asio::post(listener_->strand(), [acted, act = std::move(act)] { act([acted] { acted->set_value(); }); });
  acted->get_future().wait_for(kShutdownWait);
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
  auto services = std::make_unique<Services>(gateway, access, positions, *std::move(listener));
  if (const auto serving = services->serve(gateway, limits); !serving) return tl::unexpected(serving.error());
  return std::unique_ptr<Server>(new Server(std::move(services)));
}

const server::TcpAddress& Server::listen() const { return services_->listener().address(); }

const std::string& Server::socket() const { return services_->listener().socket(); }

const std::optional<server::TcpAddress>& Server::network() const { return services_->listener().network(); }

std::vector<server::Watchdog::Thread> Server::threads() { return services_->threads(); }

server::ConnectionCounts Server::connections() { return services_->listener().counts(); }

}  // namespace axisgate::rpc
