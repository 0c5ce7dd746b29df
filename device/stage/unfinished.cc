#include "device/stage/unfinished.h"

#include <utility>

namespace axisgate::stage {

Inheritance within(AxisSet axes, Inheritance left) {
  if (left.unfinished) {
    left.unfinished->moving = left.unfinished->moving & axes;
    left.unfinished->jogged = left.unfinished->jogged & axes;
    if (left.unfinished->moving.empty()) left.unfinished.reset();
  }
  for (Stop& stop : left.open_stops) stop.axes = stop.axes & axes;
  std::erase_if(left.open_stops, [](const Stop& stop) { return stop.axes.empty(); });
  return left;
}

}  // namespace axisgate::stage
