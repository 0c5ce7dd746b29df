// Positions that the controller saves by number: places, PIT: (manual 127) to 131)), and coordinates, PAV: (132) to
// 136)).
#pragma once

#include <cstdint>
#include <map>
#include <string_view>

#include "device/shrc203/stage.h"
#include "device/stage/position_slot.h"

namespace axisgate::shrc203 {

PositionLines position_lines(const PositionSlot& slot);

// Returns the coordinates in pulses by axis from the answer to PIT:GET or PAV:GET; empty if the answer has none.
std::map<int, std::int64_t> read_position(const PositionSlot& slot, std::string_view answer, AxisSet controllable);

}  // namespace axisgate::shrc203
