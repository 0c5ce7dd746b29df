// The registered positions: PIT: (manual 127) to 131)) keeps where the stage stands, PAV: (manual 132) to 136)) what
// the counter reads.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "device/shrc203/simulator/axis_set.h"

namespace axisgate::shrc203::simulator {

struct Rig;

// PIT: an axis's place and the DIVIDE whose pulses it counts; PAV: the coordinate.
struct SavedPosition {
  std::array<std::int64_t, kAxes> pulses{};
  std::array<std::int64_t, kAxes> divide{};
};

struct SavedPositions {
  static constexpr int kCount = 20;
  using Table = std::array<std::optional<SavedPosition>, kCount>;

  Table places;       // PIT:, gone after a reboot (manual 128))
  Table coordinates;  // PAV:, of which the manual does not say so: kept
};

// PIT:GET,n and PAV:GET,n: coordinates of today's counter, or nothing for NG.
std::optional<std::string> answer_saved_position(const Rig& rig, std::string_view line);

}  // namespace axisgate::shrc203::simulator
