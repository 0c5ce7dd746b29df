// Number of trigger pulses of a scan, computed from the counter that the trigger counts. The counter is read while the
// axis is stationary, at arming and after each reading that may be the end.
#pragma once

#include <optional>
#include <string>

#include "device/shrc203/session/dialogue.h"
#include "device/shrc203/state/live_motion.h"
#include "device/shrc203/state/state_store.h"

namespace axisgate::shrc203 {

class TriggerCount {
 public:
  TriggerCount(Dialogue& dialogue, const StateStore& store) : dialogue_(dialogue), store_(store) {}

  // Reads the counter. Call right before the trigger is armed.
  Task<void> begin(LiveMotionPtr live);
  // Sets ScanResult::observed. No effect if begin() has not read the counter.
  Task<void> count(LiveMotionPtr live);
  // Returns the resolution of the axis's scale (manual 9) ?:R); nullopt if the controller does not report it.
  Task<std::optional<Decimal>> read_scale_pulse(int axis, std::string caller);

 private:
  Task<std::optional<std::int64_t>> read(LiveMotionPtr live);

  Dialogue& dialogue_;
  const StateStore& store_;
};

}  // namespace axisgate::shrc203
