#include "server/proto/transactions.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "device/core/escape.h"

namespace axisgate::proto {
namespace {

// Longer than any line of the controller.
constexpr std::size_t kWireTextMax = 512;

// Bounded, so that it does not overflow nanoseconds.
Duration to_timeout(const google::protobuf::Duration& timeout) {
  return std::chrono::seconds(std::clamp<std::int64_t>(timeout.seconds(), -1, 3600)) +
         std::chrono::nanoseconds(timeout.nanos());
}

}  // namespace

api::Transaction to_transaction(const v1::ExecuteRequest& request) {
  api::Transaction transaction{.lines = {request.lines().begin(), request.lines().end()}};
  if (request.has_timeout()) transaction.timeout = to_timeout(request.timeout());
  return transaction;
}

v1::ExecuteResponse to_response(std::string_view device, const stage::ExecuteEvent& event) {
  v1::ExecuteResponse response;
  if (event.kind == stage::ExecuteEvent::Kind::motion) {
    response.set_motion(fmt::format("{}/motions/{}", device, event.motion));
    return response;
  }
  if (event.kind == stage::ExecuteEvent::Kind::completion) {
    response.set_completion(event.axis);
    return response;
  }
  v1::LineReply& reply = *response.mutable_reply();
  reply.set_line(static_cast<int>(event.line) + 1);
  reply.set_answer(escaped(event.answer, kWireTextMax));
  reply.set_sent(event.sent);
  reply.set_wire_reply(escaped(event.wire_reply, kWireTextMax));
  return response;
}

v1::Command to_proto(const stage::CommandInfo& info) {
  static_assert(static_cast<int>(Lane::stop) + 1 == v1::LANE_STOP);
  static_assert(static_cast<int>(Lane::poll) + 1 == v1::LANE_POLL);
  v1::Command command;
  command.set_name(info.name);
  command.set_format(info.format);
  command.set_description(info.description);
  for (const std::string& parameter : info.parameters) command.add_parameters(parameter);
  command.set_section(info.section);
  command.set_lane(static_cast<v1::Lane>(static_cast<int>(info.lane) + 1));
  command.set_moves(info.moves);
  return command;
}

}  // namespace axisgate::proto
