#include "device/stage/state.h"

namespace axisgate::stage {

std::string_view name(LinkState state) {
  switch (state) {
    case LinkState::down:
      return "DOWN";
    case LinkState::connecting:
      return "CONNECTING";
    case LinkState::up:
      return "UP";
    case LinkState::doubtful:
      return "DOUBTFUL";
    case LinkState::babbling:
      return "BABBLING";
  }
  return "DOWN";
}

AxisSet State::controllable() const {
  AxisSet set;
  for (int number = 1; number <= kAxesMax; ++number) {
    if (axis(number).controllable) set.add(number);
  }
  return set;
}

}  // namespace axisgate::stage
