// Times for which running paths keep the line free for their next refill.
#pragma once

#include <map>
#include <optional>

#include "device/core/time.h"
#include "device/shot/stage.h"

namespace axisgate::shot {

// Reservations has at most one entry for each path:
//
//   refill written ──── others may begin what ends by `due` ──── due: a segment ends ──── expires: others continue
//                                                                └ the refill is written, and the next one reserved
class Reservations {
 public:
  void keep(MotionId path, TimePoint due) { due_[path] = due; }
  void release(MotionId path) { due_.erase(path); }
  void clear() { due_.clear(); }
  bool empty() const { return due_.empty(); }

  // Reports whether an exchange of at most `length` may begin now. The reservation of `motion` itself does not count.
  bool allow(MotionId motion, Duration length, TimePoint now) const;
  // Returns the time at which the next reservation expires; nullopt if none is in force at `now`.
  std::optional<TimePoint> next_expiry(TimePoint now) const;

 private:
  std::map<MotionId, TimePoint> due_;
};

}  // namespace axisgate::shot
