#include "server/rpc/grpc_door.h"

#include <fmt/format.h>
#include <grpc/health/v1/health.grpc.pb.h>
#include <grpc/support/log.h>
#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>

#include <chrono>
#include <optional>
#include <utility>
#include <vector>

#include "server/limits.h"
#include "server/log.h"
#include "server/rpc/calls/half_close.h"
#include "server/rpc/calls/queue_waker.h"
#include "server/rpc/calls/unreadable.h"
#include "server/rpc/gate/call_filter.h"
#include "server/rpc/gate/refusals.h"
#include "server/rpc/gate/rpc_metrics.h"
#include "server/rpc/services.h"

namespace axisgate::rpc {
namespace {

// gRPC's log lines add no information to the daemon's, so they are logged at debug level only.
void log_quietly(gpr_log_func_args* line) { server::log::debug("gRPC: {}", line->message); }

}  // namespace

class GrpcDoor::Members {
 public:
  Members(server::Gateway& gateway, api::Api& api);

  Result<void> start();
  void enter(Descriptor connection);
  void end();
  server::Watchdog::Thread thread();

  Refusals refusals;
  CallFilter filter;

 private:
  void build();

  server::Gateway& gateway_;
  const HalfClose half_close_;
  RpcMetrics rpc_metrics_;
  std::vector<std::unique_ptr<grpc::Service>> services_;
  std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> acceptor_;
  std::unique_ptr<grpc::Server> grpc_;                          // null before start()
  std::shared_ptr<grpc::health::v1::Health::Stub> own_client_;  // a client within this process
  std::optional<QueueWaker> waker_;                             // none before start() and after end()
  bool ended_ = false;
};

GrpcDoor::Members::Members(server::Gateway& gateway, api::Api& api)
    : refusals(
          *gateway.metrics().registry(),
          [&gateway](Duration wait, std::function<void()> task) { gateway.timeouts().after(wait, std::move(task)); }),
      filter(gateway, api, rpc_metrics_, refusals),
      gateway_(gateway),
      half_close_(gateway),
      rpc_metrics_(*gateway.metrics().registry()) {
  for (const ServedService& service : services()) {
    if (service.make != nullptr) services_.push_back(service.make({gateway, api, half_close_}));
  }
}

Result<void> GrpcDoor::Members::start() {
  gpr_set_log_function(log_quietly);
  build();
  if (grpc_ == nullptr) {
    return fail(Reason::internal, "gRPC does not start", "SPDLOG_LEVEL=debug shows what it says about it");
  }
  const auto channel = grpc_->InProcessChannel({});
  own_client_ = grpc::health::v1::Health::NewStub(channel);
  waker_.emplace(channel, gateway_.timeouts());
  return {};
}

void GrpcDoor::Members::build() {
  grpc::reflection::InitProtoReflectionServerBuilderPlugin();
  grpc::ServerBuilder builder;
  // gRPC would otherwise estimate the bandwidth and raise the length of frames, which the front bounds.
  builder.AddChannelArgument(GRPC_ARG_HTTP2_BDP_PROBE, 0);
  for (const auto& service : services_) builder.RegisterService(service.get());
  std::vector<std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface>> interceptors;
  interceptors.push_back(unreadable_interceptor());
  interceptors.push_back(refusals.interceptor());
  interceptors.push_back(rpc_metrics_.interceptor());
  builder.experimental().SetInterceptorCreators(std::move(interceptors));
  builder.SetMaxReceiveMessageSize(gateway_.config().limits.message_bytes);
  // The front bounds metadata.
  constexpr int kMetadataBytes = 64 << 10;
  builder.AddChannelArgument(GRPC_ARG_MAX_METADATA_SIZE, kMetadataBytes);
  using Type = grpc::ServerBuilder::experimental_type::ExternalConnectionType;
  // The front identifies and authorizes the caller.
  acceptor_ = builder.experimental().AddExternalConnectionAcceptor(Type::FROM_FD, grpc::InsecureServerCredentials());
  grpc_ = builder.BuildAndStart();
}

// gRPC's threads answer when a call that the daemon makes to itself has passed through them.
server::Watchdog::Thread GrpcDoor::Members::thread() {
  const auto ask = [client = own_client_](std::function<void()> answer) {
    struct Call {
      grpc::ClientContext context;
      grpc::health::v1::HealthCheckRequest request;
      grpc::health::v1::HealthCheckResponse response;
    };
    const auto call = std::make_shared<Call>();
    client->async()->Check(&call->context, &call->request, &call->response,
                           [call, answer = std::move(answer)](const grpc::Status& status) {
                             if (status.ok()) answer();
                           });
  };
  return {"gRPC", ask};
}

void GrpcDoor::Members::enter(Descriptor connection) {
  grpc::experimental::ExternalConnectionAcceptor::NewConnectionParameters parameters;
  parameters.fd = connection.release();
  acceptor_->HandleNewConnection(&parameters);
}

void GrpcDoor::Members::end() {
  waker_.reset();
  if (grpc_ == nullptr || std::exchange(ended_, true)) return;
  grpc_->Shutdown(std::chrono::system_clock::now() + server::kGrpcShutdown);
  grpc_->Wait();
}

GrpcDoor::GrpcDoor(server::Gateway& gateway, api::Api& api) : members_(std::make_unique<Members>(gateway, api)) {}

GrpcDoor::~GrpcDoor() { members_->end(); }

Result<void> GrpcDoor::start() { return members_->start(); }

void GrpcDoor::enter(Descriptor connection) { members_->enter(std::move(connection)); }

void GrpcDoor::end() { members_->end(); }

front::CallFilter& GrpcDoor::filter() { return members_->filter; }

void GrpcDoor::note(const front::Peer& peer, const front::Closing& closing) { members_->refusals.note(peer, closing); }

server::Watchdog::Thread GrpcDoor::thread() { return members_->thread(); }

}  // namespace axisgate::rpc
