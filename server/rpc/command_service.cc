#include "server/rpc/command_service.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>

#include "device/stage/kind.h"
#include "server/rpc/call.h"
#include "server/rpc/ended_stream.h"
#include "server/rpc/execute_stream.h"
#include "server/rpc/gatekeeper.h"
#include "server/rpc/unary_call.h"

namespace axisgate::rpc {
namespace {

constexpr int kLinesMax = 100;
constexpr std::size_t kLineBytesMax = 256;
constexpr Duration kTimeout = std::chrono::seconds(20);
constexpr Duration kTimeoutMax = std::chrono::minutes(10);

void fill(api::Command& command, const stage::CommandInfo& info) {
  static_assert(static_cast<int>(Lane::stop) + 1 == api::LANE_STOP);
  static_assert(static_cast<int>(Lane::poll) + 1 == api::LANE_POLL);
  command.set_name(info.name);
  command.set_format(info.format);
  command.set_description(info.description);
  for (const std::string& parameter : info.parameters) command.add_parameters(parameter);
  command.set_section(info.section);
  command.set_lane(static_cast<api::Lane>(static_cast<int>(info.lane) + 1));
  command.set_moves(info.moves);
}

// What only this service bounds; the lines themselves are the controller's to judge.
Result<void> check_lines(const api::ExecuteRequest& request) {
  if (request.lines_size() < 1 || request.lines_size() > kLinesMax) {
    return fail(Reason::invalid_request,
                fmt::format("a transaction has 1 to {} lines, not {}", kLinesMax, request.lines_size()));
  }
  for (int i = 0; i < request.lines_size(); ++i) {
    if (request.lines(i).size() > kLineBytesMax) {
      return fail(Reason::malformed_line, fmt::format("line {} is longer than {} characters", i + 1, kLineBytesMax));
    }
  }
  return {};
}

// Every such line is refused before any is sent.
Result<void> check_role(const api::ExecuteRequest& request, const grpc::CallbackServerContext& call,
                        const server::Access& access) {
  const auto special =
      std::ranges::find_if(request.lines(), [&](const std::string& line) { return access.only_for_admins(line); });
  if (special == request.lines().end()) return {};
  const Result<server::Caller> caller = caller_with_role(call, access);
  if (!caller) return tl::unexpected(caller.error());
  return check_command_role(*special, *caller, access);
}

Result<Duration> timeout_of(const api::ExecuteRequest& request) {
  if (!request.has_timeout()) return kTimeout;
  const std::int64_t seconds = request.timeout().seconds();
  const std::int32_t nanos = request.timeout().nanos();
  const Duration timeout =
      std::chrono::seconds(std::clamp<std::int64_t>(seconds, -1, 3600)) + std::chrono::nanoseconds(nanos);
  if (timeout <= Duration::zero() || timeout > kTimeoutMax) {
    return fail(Reason::out_of_range, "timeout is not above 0 and at most 10 minutes");
  }
  return timeout;
}

}  // namespace

grpc::ServerUnaryReactor* CommandService::ListCommands(grpc::CallbackServerContext*,
                                                       const api::ListCommandsRequest* request,
                                                       api::ListCommandsResponse* response) {
  const auto call = UnaryCall<api::ListCommandsResponse>::start(response);
  const Result<server::Device*> device = find_device(gateway_, request->device());
  if (!device) return call->refuse(device.error());
  call->answer([&kind = (*device)->kind()](api::ListCommandsResponse& answer) {
    for (const stage::CommandInfo& info : kind.commands()) fill(*answer.add_commands(), info);
  });
  return call.get();
}

grpc::ServerWriteReactor<api::ExecuteResponse>* CommandService::Execute(grpc::CallbackServerContext* context,
                                                                        const api::ExecuteRequest* request) {
  using Ended = EndedStream<api::ExecuteResponse>;
  const Result<server::Device*> device = find_device(gateway_, request->device());
  if (!device) return new Ended(device.error());
  if (const Result<void> checked = check_lines(*request); !checked) return new Ended(checked.error());
  if (const Result<void> allowed = check_role(*request, *context, access_); !allowed) return new Ended(allowed.error());
  const Result<Duration> timeout = timeout_of(*request);
  if (!timeout) return new Ended(timeout.error());
  Result<stage::RequestContext> asked = mutation_context(*context, request->context());
  if (const auto role = role_of(*context, access_); asked && role) {
    asked->role = *role;
  } else if (asked) {
    asked = tl::unexpected(role.error());
  }
  if (!asked) return new Ended(asked.error());
  if (!request->context().has_not_after()) asked->not_after = monotonic_now() + *timeout;
  stage::ExecuteRequest transaction{{request->lines().begin(), request->lines().end()}, *std::move(asked)};
  if (request->validate_only()) {
    const Result<void> checked = (*device)->kind().check_lines(transaction.lines);
    return checked ? new Ended(grpc::Status::OK) : new Ended(checked.error());
  }
  Result<StreamLimit::Place> place = streams_.take();
  if (!place) return new Ended(place.error());
  return ExecuteStream::start(gateway_, **device, std::move(transaction), *timeout, *std::move(place));
}

}  // namespace axisgate::rpc
