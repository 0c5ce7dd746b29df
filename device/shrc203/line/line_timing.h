// How long exchanges take on one line: what their bytes take at its baud rate, and what the controller and the way to
// it (the driver, a USB adaptor, a serial server) were seen to add.
#pragma once

#include <cstddef>
#include <deque>

#include "device/core/time.h"
#include "device/shrc203/command/codec.h"

namespace axisgate::shrc203 {

class LineTiming {
 public:
  static constexpr std::size_t kReplyBytesMax = 64;  // the longest reply on a path: Q:SPC with three long coordinates
  static constexpr std::size_t kTerminator = 2;      // CR LF
  static constexpr std::size_t kKept = 32;           // so many of the newest exchanges tell the turnaround

  explicit LineTiming(int baud) : baud_(baud) {}

  int baud() const { return baud_; }
  Duration time_of(std::size_t bytes) const;  // ten bits a byte

  void connected() { turnarounds_.clear(); }
  // A line was written and answered by `reply_bytes`, terminators not counted, `latency` later.
  void answered(std::size_t line_bytes, std::size_t reply_bytes, Duration latency);

  // What an exchange takes beyond its bytes: half of the newest took no longer, and none of them did.
  Duration usual_turnaround() const;
  Duration longest_turnaround() const;

  // From the first byte written to the last of the reply, at most.
  Duration longest_exchange(const Command& command) const;

 private:
  int baud_;
  std::deque<Duration> turnarounds_;  // oldest first
};

}  // namespace axisgate::shrc203
