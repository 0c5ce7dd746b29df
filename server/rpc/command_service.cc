#include "server/rpc/command_service.h"

#include <algorithm>
#include <chrono>
#include <vector>

#include "device/core/escape.h"
#include "server/rpc/call.h"
#include "server/rpc/subscribed_stream.h"
#include "server/rpc/unary_call.h"

namespace axisgate::rpc {
namespace {

// Longer than any line of the controller.
constexpr std::size_t kDeviceTextMax = 512;

void fill(v1::Command& command, const stage::CommandInfo& info) {
  static_assert(static_cast<int>(Lane::stop) + 1 == v1::LANE_STOP);
  static_assert(static_cast<int>(Lane::poll) + 1 == v1::LANE_POLL);
  command.set_name(info.name);
  command.set_format(info.format);
  command.set_description(info.description);
  for (const std::string& parameter : info.parameters) command.add_parameters(parameter);
  command.set_section(info.section);
  command.set_lane(static_cast<v1::Lane>(static_cast<int>(info.lane) + 1));
  command.set_moves(info.moves);
}

void fill_step(v1::ExecuteResponse& response, const stage::ExecuteEvent& event) {
  if (event.kind == stage::ExecuteEvent::Kind::completion) {
    response.set_completion(event.axis);
    return;
  }
  v1::LineReply& reply = *response.mutable_reply();
  reply.set_line(static_cast<int>(event.line));
  reply.set_answer(escaped(event.answer, kDeviceTextMax));
  reply.set_sent(event.sent);
  reply.set_wire_reply(escaped(event.wire_reply, kDeviceTextMax));
}

// Bounded, so that it does not overflow nanoseconds.
Duration to_timeout(const google::protobuf::Duration& timeout) {
  return std::chrono::seconds(std::clamp<std::int64_t>(timeout.seconds(), -1, 3600)) +
         std::chrono::nanoseconds(timeout.nanos());
}

}  // namespace

grpc::ServerUnaryReactor* CommandService::ListCommands(grpc::CallbackServerContext* context,
                                                       const v1::ListCommandsRequest* request,
                                                       v1::ListCommandsResponse* response) {
  return answer_at_once(response, commands_.list(to_call(*context), request->device()),
                        [](v1::ListCommandsResponse& answer, const std::vector<stage::CommandInfo>& commands) {
                          for (const stage::CommandInfo& info : commands) fill(*answer.add_commands(), info);
                        });
}

grpc::ServerWriteReactor<v1::ExecuteResponse>* CommandService::Execute(grpc::CallbackServerContext* context,
                                                                       const v1::ExecuteRequest* request) {
  api::Transaction transaction{.lines = {request->lines().begin(), request->lines().end()}};
  if (request->has_timeout()) transaction.timeout = to_timeout(request->timeout());
  return serve<v1::ExecuteResponse>(
      commands_.execute(to_checked_call(*context, *request), request->device(), std::move(transaction)), fill_step);
}

}  // namespace axisgate::rpc
