// Numbers of the messages that keep jogs running.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <utility>

#include "device/stage/motion.h"

namespace axisgate::api {

// JogNumbers has the highest number of each jog. Thread safe.
class JogNumbers {
 public:
  // Returns true if `number` is higher than all before it for this motion of `device`.
  bool counts(const void* device, stage::MotionId motion, std::int64_t number) {
    const std::lock_guard lock(mutex_);
    std::int64_t& highest = highest_[{device, motion}];
    if (number <= highest) return false;
    highest = number;
    return true;
  }

  // Forgets all but the newest jogs of the device; older ones have ended, because axes jog once at a time.
  void forget_before(const void* device, stage::MotionId motion) {
    constexpr stage::MotionId kKept = 100;
    const std::lock_guard lock(mutex_);
    if (motion <= kKept) return;
    highest_.erase(highest_.lower_bound({device, 0}), highest_.lower_bound({device, motion - kKept}));
  }

 private:
  std::mutex mutex_;
  std::map<std::pair<const void*, stage::MotionId>, std::int64_t> highest_;
};

}  // namespace axisgate::api
