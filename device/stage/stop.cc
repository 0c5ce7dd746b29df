#include "device/stage/stop.h"

#include <array>

namespace axisgate::stage {

std::string_view name(StopState state) {
  static constexpr std::array<std::string_view, kStopStates> kNames = {"asked", "written", "confirmed", "replaced",
                                                                       "withdrawn"};
  return kNames.at(static_cast<std::size_t>(state));
}

std::string title_of(const Stop& stop) {
  return stop.kind == StopKind::emergency ? "emergency stop" : "stop of " + to_string(stop.axes);
}

}  // namespace axisgate::stage
