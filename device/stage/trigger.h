// The trigger output of a controller.
#pragma once

#include <cstdint>

namespace axisgate::stage {

struct Trigger {
  enum class Target { none, drive_pulses, timer, scale_plus, scale_minus };
  Target target = Target::none;
  int axis = 0;               // 0 for timer and none
  std::int64_t interval = 0;  // pulses; times 0.01 s for a timer

  friend bool operator==(const Trigger&, const Trigger&) = default;
};

}  // namespace axisgate::stage
