// The times for which running paths keep the line free, so that their next refill finds nothing in its way.
#pragma once

#include <map>
#include <optional>

#include "device/core/time.h"
#include "device/shrc203/stage.h"

namespace axisgate::shrc203 {

// A path keeps one at a time:
//
//   refill written ──── others may begin what ends by `due` ──── due: a segment ends ──── expires: others go on
//                                                                └ the refill is written, and the next one is kept
class Reservations {
 public:
  void keep(MotionId path, TimePoint due) { due_[path] = due; }
  void release(MotionId path) { due_.erase(path); }
  void clear() { due_.clear(); }
  bool empty() const { return due_.empty(); }

  // Whether an exchange of at most `length` that begins now leaves them all alone. A path's own is not in its way.
  bool allow(MotionId motion, Duration length, TimePoint now) const;
  // When the next of them expires; nothing when none is in force at `now`.
  std::optional<TimePoint> next_expiry(TimePoint now) const;

 private:
  std::map<MotionId, TimePoint> due_;
};

}  // namespace axisgate::shrc203
