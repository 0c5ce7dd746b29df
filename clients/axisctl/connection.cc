#include "clients/axisctl/connection.h"

#include <fmt/format.h>
#include <google/rpc/status.pb.h>

#include <charconv>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <optional>
#include <random>
#include <string_view>
#include <thread>
#include <utility>

#include "clients/axisctl/bearer.h"
#include "clients/axisctl/failure.h"
#include "clients/axisctl/print.h"

namespace axisgate::axisctl {
namespace {

// Time within which an ending daemon closes its connections after it has refused a request.
constexpr std::chrono::milliseconds kEndOfDaemon{500};

std::string content(const std::string& path) {
  if (path.empty()) return "";
  std::ifstream file(path);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw usage(fmt::format("{} cannot be read", path), "--ca, --certificate and --key name PEM files");
  return text;
}

std::shared_ptr<grpc::ChannelCredentials> credentials(const Target& target) {
  if (!target.tls) return grpc::InsecureChannelCredentials();
  return grpc::SslCredentials({content(target.ca), content(target.key), content(target.certificate)});
}

std::shared_ptr<grpc::Channel> open_channel(const Target& target) {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  // By default gRPC would wait up to two minutes before it tries to reach a restarted daemon.
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 250);
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 5000);
  // Despite its name, this is the time limit of one connection attempt: a flooded daemon accepts a stop after a delay.
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, 5000);
  const char* const token = std::getenv(kTokenVariable);
  return grpc::experimental::CreateCustomChannelWithInterceptors(target.address, credentials(target), arguments,
                                                                 with_bearer(token == nullptr ? "" : token));
}

Failure without_details(const grpc::Status& status, const std::string& target) {
  switch (status.error_code()) {
    case grpc::StatusCode::UNAVAILABLE:
      return {kUnavailable, "UNAVAILABLE", fmt::format("no daemon answers at {}: {}", target, status.error_message()),
              "start one with `axisgated`, or name another with --target"};
    case grpc::StatusCode::DEADLINE_EXCEEDED:
      return {kDeadline, "DEADLINE_EXCEEDED", fmt::format("the daemon at {} did not answer in time", target),
              "the request may still take effect: check with `axisctl status`"};
    // The daemon refused these calls too early to send a problem.
    case grpc::StatusCode::UNAUTHENTICATED:
      return {kRefused, "UNAUTHENTICATED", status.error_message(), ""};
    case grpc::StatusCode::PERMISSION_DENIED:
      return {kRefused, "NOT_ALLOWED", status.error_message(), ""};
    case grpc::StatusCode::RESOURCE_EXHAUSTED:
      return {kRefused, "QUEUE_FULL", status.error_message(), ""};
    case grpc::StatusCode::UNIMPLEMENTED:
      return {kRefused, "UNIMPLEMENTED", fmt::format("the program at {} does not know this call", target),
              "check that it is axisgated, and of this version"};
    default:
      return {kFailed, fmt::format("GRPC_{}", static_cast<int>(status.error_code())), status.error_message(),
              "see the daemon's log"};
  }
}

// Decodes the output of lease_text(); nullopt if `text` is anything else.
std::optional<std::string> token_in(std::string_view text) {
  constexpr std::size_t kTextBytes = 48;
  if (text.size() != kTextBytes) return std::nullopt;
  std::string token;
  for (std::size_t at = 0; at < text.size(); at += 2) {
    unsigned char byte = 0;
    const auto [end, error] = std::from_chars(text.data() + at, text.data() + at + 2, byte, 16);
    if (error != std::errc() || end != text.data() + at + 2) return std::nullopt;
    token += static_cast<char>(byte);
  }
  return token;
}

}  // namespace

Connection::Connection(const Target& target, std::string request_id)
    : target_(target.address),
      request_id_(std::move(request_id)),
      channel_(open_channel(target)),
      devices(v1::DeviceService::NewStub(channel_)),
      stage(v1::StageService::NewStub(channel_)),
      events(v1::EventService::NewStub(channel_)),
      commands(v1::CommandService::NewStub(channel_)),
      diagnostics(v1::DiagnosticsService::NewStub(channel_)),
      control(v1::ControlService::NewStub(channel_)),
      access(v1::AccessService::NewStub(channel_)),
      settings(v1::SettingService::NewStub(channel_)),
      simulators(v1::SimulatorService::NewStub(channel_)),
      positions(v1::PositionService::NewStub(channel_)),
      history(v1::HistoryService::NewStub(channel_)),
      mills(v1::MillService::NewStub(channel_)) {}

void Connection::repeat_by(const v1::ListDevicesResponse& there) const {
  if (there.requests_kept()) request_memory_ = there.request_memory();
}

// An ending daemon refuses requests with a problem; a killed daemon sends none.
bool Connection::asks_again(const grpc::Status& status, std::chrono::system_clock::time_point deadline) const {
  const bool lost = status.error_code() == grpc::StatusCode::UNAVAILABLE ||
                    status.error_code() == grpc::StatusCode::CANCELLED ||
                    status.error_code() == grpc::StatusCode::INTERNAL;
  const v1::Reason reason = problem_of(status).reason();
  const bool ending = reason == v1::REASON_DAEMON_ENDING;  // the next daemon may answer
  if (!lost || request_memory_.empty() || (reason != v1::REASON_UNSPECIFIED && !ending)) return false;
  if (std::chrono::system_clock::now() >= deadline) return false;
  print_note("the connection broke; requesting again, with the same request id");
  if (ending) std::this_thread::sleep_for(kEndOfDaemon);
  return true;
}

void Connection::check(const grpc::Status& status) const {
  if (status.ok()) return;
  const v1::Problem problem = problem_of(status);
  if (problem.reason() == v1::REASON_UNSPECIFIED) throw without_details(status, target_);
  throw to_failure(problem);
}

v1::Problem problem_of(const grpc::Status& status) {
  google::rpc::Status details;
  v1::Problem problem;
  if (!details.ParseFromString(status.error_details())) return problem;
  for (const google::protobuf::Any& detail : details.details()) {
    if (detail.UnpackTo(&problem)) return problem;
  }
  return v1::Problem();
}

std::string lease_text(std::string_view token) {
  std::string text;
  for (const char byte : token) text += fmt::format("{:02x}", static_cast<unsigned char>(byte));
  return text;
}

v1::CallContext new_stop_context() {
  std::random_device random;
  v1::CallContext context;
  context.set_request_id(fmt::format("axisctl-{:08x}{:08x}", random(), random()));
  const char* const lease = std::getenv(kLeaseVariable);
  if (const auto token = token_in(lease ? lease : "")) context.set_lease_token(*token);
  return context;
}

v1::CallContext Connection::new_call_context() const {
  v1::CallContext context = new_stop_context();
  if (!request_id_.empty()) context.set_request_id(request_id_);
  const char* const lease = std::getenv(kLeaseVariable);
  if (lease && context.lease_token().empty()) {
    throw usage(fmt::format("{} is not the token of a lease", kLeaseVariable),
                "unset it, or start again with `axisctl lease run`");
  }
  return context;
}

}  // namespace axisgate::axisctl
