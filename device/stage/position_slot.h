// Where a controller keeps a position: by number only, and of two sorts.
#pragma once

#include <string>

namespace axisgate::stage {

struct PositionSlot {
  bool place = true;  // a place of the stage; else a set of coordinates
  int number = 0;     // 1 to 20
};

// What is done with it beside going there.
struct PositionLines {
  std::string save;  // where the stage stands
  std::string tell;  // its coordinates
  std::string forget;
};

}  // namespace axisgate::stage
