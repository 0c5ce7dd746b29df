// Time at which a jog must be stopped before the end of its travel. Pure computation.
#pragma once

#include <cstdint>
#include <optional>

#include "device/core/time.h"
#include "device/shrc203/state/live_motion.h"
#include "device/shrc203/state/state_store.h"

namespace axisgate::shrc203 {

class JogBound {
 public:
  // Uses the state at `now`. The referenced objects must outlive this one.
  JogBound(const StateStore& store, const LiveMotion& live, TimePoint now) : store_(store), live_(live), now_(now) {}

  // Returns the latest time for requesting a stop of the axis: computed from the last reading with the highest speed
  // since then, or with `speed` in pulses/s. nullopt if the axis was not read.
  std::optional<TimePoint> stop_at(int axis) const;
  std::optional<TimePoint> stop_at(int axis, std::int64_t speed) const;
  // Returns the requested speed, or the lower speed that the distance to the bound still allows; in pulses/s.
  std::int64_t speed_that_fits(int axis) const;

 private:
  const StateStore& store_;
  const LiveMotion& live_;
  const TimePoint now_;
};

}  // namespace axisgate::shrc203
