// Waiting until a path's axes are stationary, and where they are then.
#pragma once

#include <array>
#include <cstdint>

#include "device/core/tasks.h"
#include "device/shrc203/session/reader.h"
#include "device/shrc203/state/live_motion.h"
#include "device/shrc203/state/state_store.h"

namespace axisgate::shrc203 {

using Place = std::array<std::int64_t, kAxisCount>;  // in pulses, by axis

class Standstill {
 public:
  Standstill(Reader& reader, const StateStore& store, Tasks& tasks) : reader_(reader), store_(store), tasks_(tasks) {}

  // READY twice in a row at the same place. False: the line was lost.
  Task<bool> wait(LiveMotionPtr live);
  // For that time. False: a stop, or the line was lost.
  Task<bool> wait_until(LiveMotionPtr live, TimePoint limit);
  // Within `slack` pulses on each axis.
  bool is_at(AxisSet axes, const Place& place, std::int64_t slack) const;

 private:
  Reader& reader_;
  const StateStore& store_;
  Tasks& tasks_;
};

}  // namespace axisgate::shrc203
