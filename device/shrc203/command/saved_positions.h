// The positions that the controller keeps, by number: its places, PIT: (manual 127) to 131)), and its sets of
// coordinates, PAV: (132) to 136)).
#pragma once

#include <cstdint>
#include <map>
#include <string_view>

#include "device/shrc203/stage.h"
#include "device/stage/position_slot.h"

namespace axisgate::shrc203 {

PositionLines position_lines(const PositionSlot& slot);

// In pulses, by axis, from the answer to PIT:GET or PAV:GET; nothing where it reports none.
std::map<int, std::int64_t> read_position(const PositionSlot& slot, std::string_view answer, AxisSet controllable);

}  // namespace axisgate::shrc203
