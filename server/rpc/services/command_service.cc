#include "server/rpc/services/command_service.h"

#include <vector>

#include "server/rpc/calls/call.h"
#include "server/rpc/calls/unary_call.h"

namespace axisgate::rpc {
namespace {

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

}  // namespace

grpc::ServerUnaryReactor* CommandService::ListCommands(grpc::CallbackServerContext* context,
                                                       const v1::ListCommandsRequest* request,
                                                       v1::ListCommandsResponse* response) {
  return answer_at_once(response, commands_.list(to_call(*context), request->device()),
                        [](v1::ListCommandsResponse& answer, const std::vector<stage::CommandInfo>& commands) {
                          for (const stage::CommandInfo& info : commands) fill(*answer.add_commands(), info);
                        });
}

}  // namespace axisgate::rpc
