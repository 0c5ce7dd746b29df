// Requests as texts for the log.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "device/stage/requests.h"

namespace axisgate::api {

// Returns "move axis 1 to 5 mm, axis 2 to 100 pulse" or "move axis 1 by -3 um".
std::string text_of(const stage::MoveRequest& move);
// Returns "scan axis 1 from 0 mm to 5 mm".
std::string text_of(const stage::ScanRequest& scan);
// Returns "jog axis 1 plus at 2 mm/s, axis 2 minus at its minimum speed".
std::string text_of(const stage::JogRequest& jog);
// Returns "home axis 1" or "home all axes".
std::string text_of(std::string_view verb, stage::AxisSet axes);
// Returns "change settings: D:1,100,1000,100 | C:1,1". The lines are not escaped.
std::string text_of(std::string_view verb, const std::vector<std::string>& lines);

}  // namespace axisgate::api
