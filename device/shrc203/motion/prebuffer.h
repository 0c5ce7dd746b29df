// Content of a running path's prebuffer, read when the completion that ends a segment is in doubt.
#pragma once

#include <optional>

#include "device/core/tasks.h"
#include "device/shot/line/line.h"
#include "device/shrc203/motion/standstill.h"
#include "device/shrc203/session/dialogue.h"
#include "device/shrc203/session/stops.h"
#include "device/shrc203/state/motions.h"
#include "device/shrc203/state/registers.h"
#include "device/shrc203/state/state_store.h"

namespace axisgate::shrc203 {

class Prebuffer {
 public:
  Prebuffer(Dialogue& dialogue, Line& line, Stops& stops, Standstill& standstill, const StateStore& store,
            Motions& motions, const Tasks& tasks)
      : dialogue_(dialogue),
        line_(line),
        stops_(stops),
        standstill_(standstill),
        store_(store),
        motions_(motions),
        tasks_(tasks) {}

  // Segment that was put into the prebuffer last.
  struct Sent {
    int number = 0;
    Command setter;
  };
  // Reports whether the prebuffer is empty, so that the segment runs. If the segment was received wrongly, all axes are
  // stopped and the motion ends.
  Task<bool> is_empty(LiveMotionPtr live, Sent sent);

 private:
  Task<std::optional<Held>> read(LiveMotionPtr live, Command setter);
  Task<void> stop_wrong_segment(LiveMotionPtr live, Sent sent);

  Dialogue& dialogue_;
  Line& line_;
  Stops& stops_;
  Standstill& standstill_;
  const StateStore& store_;
  Motions& motions_;
  const Tasks& tasks_;
};

}  // namespace axisgate::shrc203
