// Program mode as seen on the line (manual 102) to 116), 41)).
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "device/shrc203/simulator/rig.h"

namespace axisgate::shrc203::simulator {

// Reports whether program mode, or its edit mode, knows the command. It knows all P: commands, and answers NG to those
// that do not work there.
bool works_in_program_mode(const Rig& rig, std::string_view command);

// Reports whether the line is P:GET, which manual 115) also writes as P:GEL. `line` is in upper case and has no blanks.
bool asks_for_program_line(std::string_view line);
std::optional<std::string> answer_program_line(const Rig& rig, std::string_view line);

std::string program_status(const Rig& rig);  // ?:L

}  // namespace axisgate::shrc203::simulator
