// The command table for people.
#pragma once

#include <vector>

#include "device/stage/command_info.h"

namespace axisgate::shrc203 {

std::vector<stage::CommandInfo> list_commands();  // in the manual's order

}  // namespace axisgate::shrc203
