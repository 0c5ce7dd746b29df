// Waiting until a path's axes are stationary, and comparing their positions.
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

  // Waits for READY twice in a row at the same position. Returns false if the line was lost.
  Task<bool> wait(LiveMotionPtr live);
  // Waits until `limit`. Returns false after a stop, or if the line was lost.
  Task<bool> wait_until(LiveMotionPtr live, TimePoint limit);
  // Reports whether all axes are at the place, within `slack` pulses.
  bool is_at(AxisSet axes, const Place& place, std::int64_t slack) const;

 private:
  Reader& reader_;
  const StateStore& store_;
  Tasks& tasks_;
};

}  // namespace axisgate::shrc203
