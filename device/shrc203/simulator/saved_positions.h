// Saved positions: PIT: (manual 127) to 131)) saves the stage's position, PAV: (manual 132) to 136)) the counter's.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "device/shrc203/simulator/axis_set.h"

namespace axisgate::shrc203::simulator {

struct Rig;

// For PIT:, the position of each axis and the DIVIDE that defines its pulses; for PAV:, the coordinate.
struct SavedPosition {
  std::array<std::int64_t, kAxes> pulses{};
  std::array<std::int64_t, kAxes> divide{};
};

struct SavedPositions {
  static constexpr int kCount = 20;
  using Table = std::array<std::optional<SavedPosition>, kCount>;

  Table places;       // PIT:, lost after a reboot (manual 128))
  Table coordinates;  // PAV:, kept: the manual does not say that they are lost
};

// Answers PIT:GET,n and PAV:GET,n with coordinates of the present counter; nullopt for NG.
std::optional<std::string> answer_saved_position(const Rig& rig, std::string_view line);

}  // namespace axisgate::shrc203::simulator
