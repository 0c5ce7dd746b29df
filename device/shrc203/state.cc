#include "device/shrc203/state.h"

namespace axisgate::shrc203 {

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
  }
  return "DOWN";
}

bool AxisStatusBits::any_error() const {
  for (const int number : {3, 4, 5, 6, 7, 8, 9, 10, 13, 15}) {
    if (bit(number)) return true;
  }
  return false;
}

AxisSet State::controllable() const {
  AxisSet set;
  for (int number = 1; number <= kAxisCount; ++number) {
    if (axis(number).controllable) set.add(number);
  }
  return set;
}

}  // namespace axisgate::shrc203
