// Numbers of the messages that keep jogs running.
#pragma once

#include <cstddef>
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

  // Forgets the jogs of `device` that have ended, once there are many.
  template <class Ended>
  void forget_ended(const void* device, Ended has_ended) {
    constexpr std::size_t kMany = 64;
    const std::lock_guard lock(mutex_);
    if (highest_.size() < kMany) return;
    std::erase_if(highest_, [&](const auto& one) { return one.first.first == device && has_ended(one.first.second); });
  }

 private:
  std::mutex mutex_;
  std::map<std::pair<const void*, stage::MotionId>, std::int64_t> highest_;
};

}  // namespace axisgate::api
