// Detection of a device that sends without end. Its limit: within one second, bytes that belong to no reply or notice
// exceed half of the line's capacity. Garbage and late replies stay far below this limit.
#pragma once

#include <cstddef>
#include <cstdint>

#include "device/core/time.h"

namespace axisgate::shot {

class Flood {
 public:
  static constexpr Duration kWindow = std::chrono::seconds(1);

  explicit Flood(int baud) : limit_(baud / kBitsPerByte / 2) {}

  void connected() { unclaimed_ = 0; }
  void received(std::size_t bytes, TimePoint now);
  // Subtracts received bytes that belonged to a reply or a completion.
  void belonged(std::size_t bytes);
  bool too_much() const { return unclaimed_ > limit_; }

 private:
  static constexpr int kBitsPerByte = 10;

  std::int64_t limit_;
  TimePoint window_{};  // start of the present window
  std::int64_t unclaimed_ = 0;
};

}  // namespace axisgate::shot
