// Program mode as the line sees it (manual 102) to 116), 41)).
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "device/shrc203/simulator/rig.h"

namespace axisgate::shrc203::simulator {

// Whether program mode, or its edit mode, has such a command. Of P: it has those that work there, the others are NG.
bool works_in_program_mode(const Rig& rig, std::string_view command);

// P:GET, which manual 115) writes P:GEL in its formats. In upper case and without blanks.
bool asks_for_program_line(std::string_view line);
std::optional<std::string> answer_program_line(const Rig& rig, std::string_view line);

std::string program_status(const Rig& rig);  // ?:L

}  // namespace axisgate::shrc203::simulator
