// axisgate-bench-server: a minimal gateway with the same gRPC and Asio as the daemon, but without the daemon's other
// duties. The difference between the figures of both is the cost of these duties.
//
// Its code is frozen, neither improved nor corrected, so that figures of different days stay comparable.
#include <fmt/format.h>
#include <grpcpp/grpcpp.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>

#include "bench/minimal.grpc.pb.h"
#include "tests/bench/minimal_line.h"
#include "tests/bench/minimal_watchers.h"

namespace axisgate::bench {
namespace {

struct Options {
  std::string socket, tty, certificates;
  double events_per_second = 50;
};

class Service final : public Minimal::CallbackService {
 public:
  explicit Service(const std::string& tty) {
    if (!tty.empty()) line_.emplace(tty);
  }

  grpc::ServerUnaryReactor* Hello(grpc::CallbackServerContext* context, const HelloRequest*, HelloResponse*) override {
    auto* const reactor = context->DefaultReactor();
    reactor->Finish(grpc::Status::OK);
    return reactor;
  }

  grpc::ServerUnaryReactor* Ask(grpc::CallbackServerContext* context, const AskRequest* request,
                                AskResponse* response) override {
    auto* const reactor = context->DefaultReactor();
    if (!line_) {
      reactor->Finish({grpc::StatusCode::FAILED_PRECONDITION, "there is no tty"});
      return reactor;
    }
    line_->ask(request->line(), [reactor, response](const std::string& reply) {
      response->set_reply(reply);
      reactor->Finish(grpc::Status::OK);
    });
    return reactor;
  }

 private:
  std::optional<MinimalLine> line_;
};

std::string content(const std::string& path) {
  std::ifstream file(path);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw std::runtime_error(path + " cannot be read");
  return text;
}

std::shared_ptr<grpc::ServerCredentials> tls(const std::string& folder) {
  grpc::SslServerCredentialsOptions options;
  options.pem_key_cert_pairs.push_back({content(folder + "/gateway.key"), content(folder + "/gateway.crt")});
  return grpc::SslServerCredentials(options);
}

void serve(const Options& options) {
  constexpr const char* kAnyPort = "127.0.0.1:0";
  Service service(options.tty);
  MinimalWatchers watchers(options.events_per_second);
  grpc::ServerBuilder builder;
  int tcp_port = 0, tls_port = 0;
  builder.AddListeningPort("unix:" + options.socket, grpc::InsecureServerCredentials());
  builder.AddListeningPort(kAnyPort, grpc::InsecureServerCredentials(), &tcp_port);
  if (!options.certificates.empty()) builder.AddListeningPort(kAnyPort, tls(options.certificates), &tls_port);
  builder.RegisterService(&service);
  builder.RegisterService(&watchers);
  const auto server = builder.BuildAndStart();
  if (!server) throw std::runtime_error("it cannot listen");
  fmt::print("serves tcp 127.0.0.1:{} tls 127.0.0.1:{}\n", tcp_port, tls_port);
  std::fflush(stdout);
  server->Wait();  // until a signal ends the process
}

}  // namespace
}  // namespace axisgate::bench

int main(int count, char** words) {
  CLI::App program("The smallest gateway, beside which the daemon is measured.", "axisgate-bench-server");
  axisgate::bench::Options options;
  program.add_option("--socket", options.socket, "Unix socket to make")->required();
  program.add_option("--tty", options.tty, "The controller's line");
  program.add_option("--certificates", options.certificates, "Folder with gateway.crt and gateway.key: TLS, too");
  program.add_option("--events-per-second", options.events_per_second, "To each stream of EventService.Watch")
      ->check(CLI::PositiveNumber);
  CLI11_PARSE(program, count, words);
  try {
    axisgate::bench::serve(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "axisgate-bench-server: {}\n", error.what());
    return 1;
  }
  return 0;
}
