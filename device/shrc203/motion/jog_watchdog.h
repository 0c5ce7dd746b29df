// Watchdog of jogs: ends a jog when it must end, sends new speeds, and stops the jog again if one stop was not enough.
#pragma once

#include <optional>

#include "device/core/tasks.h"
#include "device/shrc203/session/dialogue.h"
#include "device/shrc203/session/stops.h"
#include "device/shrc203/state/motions.h"
#include "device/shrc203/state/rights.h"

namespace axisgate::shrc203 {

class JogWatchdog {
 public:
  JogWatchdog(Dialogue& dialogue, Stops& stops, const StateStore& store, Motions& motions, Rights& rights, Tasks& tasks)
      : dialogue_(dialogue), stops_(stops), store_(store), motions_(motions), rights_(rights), tasks_(tasks) {}

  // Runs until the jog has its outcome.
  Task<void> run(LiveMotionPtr live);

 private:
  std::optional<Problem> must_end(const LiveMotion& live);
  std::optional<Problem> near_bound(const LiveMotion& live) const;
  TimePoint next_look(const LiveMotion& live) const;
  void stop(LiveMotionPtr live);
  Task<void> change_speeds(LiveMotionPtr live);

  Dialogue& dialogue_;
  Stops& stops_;
  const StateStore& store_;
  Motions& motions_;
  Rights& rights_;
  Tasks& tasks_;
};

}  // namespace axisgate::shrc203
