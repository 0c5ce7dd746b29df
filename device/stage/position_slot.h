// A position that the controller saves, by number only and in two kinds.
#pragma once

#include <string>

namespace axisgate::stage {

struct PositionSlot {
  bool place = true;  // true: a place of the stage; false: a set of coordinates
  int number = 0;     // 1 to 20
};

// Command lines for a saved position, except the one that moves to it.
struct PositionLines {
  std::string save;  // saves the present position
  std::string tell;  // asks for the coordinates
  std::string forget;
};

}  // namespace axisgate::stage
