// Conversion of transactions of a caller's own lines from and to messages.
#pragma once

#include <string_view>

#include "axisgate/v1/command.pb.h"
#include "device/stage/command_info.h"
#include "device/stage/stage_controller.h"
#include "server/api/stage/commands.h"

namespace axisgate::proto {

api::Transaction to_transaction(const v1::ExecuteRequest& request);

// `event` is not the end of the transaction. The device's texts are escaped in the result.
v1::ExecuteResponse to_response(std::string_view device, const stage::ExecuteEvent& event);

v1::Command to_proto(const stage::CommandInfo& info);

}  // namespace axisgate::proto
