#include "server/rpc/server.h"

#include <fmt/format.h>
#include <grpc/support/log.h>
#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server_builder.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <utility>

#include "server/endpoints.h"

namespace axisgate::rpc {
namespace {

constexpr auto kShutdownWait = std::chrono::milliseconds(500);

// gRPC's own lines tell nothing that ours do not, and would stand among them unasked.
void log_quietly(gpr_log_func_args* line) { spdlog::debug("gRPC: {}", line->message); }

}  // namespace

Server::Server(server::Gateway& gateway, server::TcpAddress listen, std::string socket)
    : listen_(std::move(listen)),
      socket_(std::move(socket)),
      devices_(gateway, streams_),
      stage_(gateway, streams_),
      events_(gateway, streams_),
      commands_(gateway, streams_),
      health_(streams_) {}

Result<std::unique_ptr<Server>> Server::start(server::Gateway& gateway, const server::TcpAddress& listen,
                                              const std::string& socket) {
  gpr_set_log_function(log_quietly);
  if (const Result<void> free = server::check_port_free(listen); !free) return tl::unexpected(free.error());
  if (const Result<void> ready = server::prepare_socket(socket); !ready) return tl::unexpected(ready.error());
  std::unique_ptr<Server> server(new Server(gateway, listen, socket));
  if (const Result<void> built = server->build(); !built) return tl::unexpected(built.error());
  server::open_socket_to_users(socket);
  return server;
}

Result<void> Server::build() {
  grpc::reflection::InitProtoReflectionServerBuilderPlugin();
  grpc::ServerBuilder builder;
  // With it a second daemon would take half of the first one's connections instead of being refused.
  builder.AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);
  int tcp_port = 0;
  int socket_port = 0;
  builder.AddListeningPort(to_string(listen_), grpc::InsecureServerCredentials(), &tcp_port);
  builder.AddListeningPort("unix:" + socket_, grpc::InsecureServerCredentials(), &socket_port);
  for (grpc::Service* service :
       std::initializer_list<grpc::Service*>{&devices_, &stage_, &events_, &commands_, &health_}) {
    builder.RegisterService(service);
  }
  server_ = builder.BuildAndStart();
  if (server_ == nullptr || tcp_port == 0 || socket_port == 0) {
    return fail(Reason::internal, fmt::format("cannot serve gRPC on {} and {}", to_string(listen_), socket_),
                "SPDLOG_LEVEL=debug shows what gRPC says about it");
  }
  listen_.port = static_cast<std::uint16_t>(tcp_port);
  return {};
}

Server::~Server() {
  if (server_ == nullptr) return;
  server_->Shutdown(std::chrono::system_clock::now() + kShutdownWait);
  server_->Wait();
}

}  // namespace axisgate::rpc
