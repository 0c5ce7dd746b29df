#include "clients/axisctl/connection.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <optional>
#include <random>
#include <string_view>
#include <thread>
#include <utility>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/print.h"
#include "clients/cpp/src/channel.h"
#include "clients/cpp/src/failure.h"
#include "clients/cpp/src/token.h"

namespace axisgate::axisctl {
namespace {

// Time within which an ending daemon closes its connections after it has refused a request.
constexpr std::chrono::milliseconds kEndOfDaemon{500};

// Opens a channel. Throws Failure if the target cannot be used.
std::shared_ptr<grpc::Channel> channel_to(const client::Target& target) {
  try {
    client::check(target);
    return client::open_channel(target);
  } catch (const InvalidArgument& error) {
    throw usage(error.what(), "--ca, --certificate and --key name PEM files");
  }
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

// Decodes the output of client::token_text(); nullopt if `text` is anything else.
std::optional<std::string> token_in(std::string_view text) {
  try {
    return client::token_bytes(text);
  } catch (const InvalidArgument&) {
    return std::nullopt;
  }
}

}  // namespace

Connection::Connection(const client::Target& target, std::string request_id)
    : target_(target.address),
      request_id_(std::move(request_id)),
      channel_(channel_to(target)),
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

v1::Problem problem_of(const grpc::Status& status) { return client::Failure(status).problem.value_or(v1::Problem()); }

v1::CallContext new_stop_context() {
  std::random_device random;
  v1::CallContext context;
  context.set_request_id(fmt::format("axisctl-{:08x}{:08x}", random(), random()));
  const char* const lease = std::getenv(client::kLeaseVariable);
  if (const auto token = token_in(lease ? lease : "")) context.set_lease_token(*token);
  return context;
}

v1::CallContext Connection::new_call_context() const {
  v1::CallContext context = new_stop_context();
  if (!request_id_.empty()) context.set_request_id(request_id_);
  const char* const lease = std::getenv(client::kLeaseVariable);
  if (lease && context.lease_token().empty()) {
    throw usage(fmt::format("{} is not the token of a lease", client::kLeaseVariable),
                "unset it, or start again with `axisctl lease run`");
  }
  return context;
}

}  // namespace axisgate::axisctl
