// How many trigger pulses a scan has had, by the counter that the trigger counts by: it is read while the axis is
// stationary, at the arming and whenever a reading may be the end.
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

  // The trigger is about to be armed.
  Task<void> begin(LiveMotionPtr live);
  // Into ScanResult::observed; nothing before begin().
  Task<void> count(LiveMotionPtr live);
  // What one pulse of the axis's scale is (manual 9) ?:R); nothing where the controller does not tell.
  Task<std::optional<Decimal>> read_scale_pulse(int axis, std::string caller);

 private:
  Task<std::optional<std::int64_t>> read(LiveMotionPtr live);

  Dialogue& dialogue_;
  const StateStore& store_;
};

}  // namespace axisgate::shrc203
