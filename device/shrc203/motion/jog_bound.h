// When a jog must be stopped, so that it does not come to the end of its travel. Pure computation.
#pragma once

#include <cstdint>
#include <optional>

#include "device/core/time.h"
#include "device/shrc203/state/live_motion.h"
#include "device/shrc203/state/state_store.h"

namespace axisgate::shrc203 {

class JogBound {
 public:
  // As things are now. All outlive it.
  JogBound(const StateStore& store, const LiveMotion& live, TimePoint now) : store_(store), live_(live), now_(now) {}

  // When at the latest a stop of the axis must be requested: computed from the last reading at the highest speed since
  // then, or at `speed` pulses/s. Nothing where the axis was not read.
  std::optional<TimePoint> stop_at(int axis) const;
  std::optional<TimePoint> stop_at(int axis, std::int64_t speed) const;
  // The requested speed, or what the distance to the bound still allows; in pulses/s.
  std::int64_t speed_that_fits(int axis) const;

 private:
  const StateStore& store_;
  const LiveMotion& live_;
  const TimePoint now_;
};

}  // namespace axisgate::shrc203
