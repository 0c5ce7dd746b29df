// The command table as text for people.
#pragma once

#include <span>
#include <vector>

#include "device/stage/command_info.h"
#include "device/stage/kind.h"

namespace axisgate::shrc203 {

std::vector<stage::CommandInfo> list_commands();  // in the manual's order
std::span<const stage::AdminCommand> admin_commands();

}  // namespace axisgate::shrc203
