// Duration of exchanges on one line: the time of their bytes at the baud rate, and the measured delay of the controller
// and its connection (driver, USB adaptor, serial server).
#pragma once

#include <cstddef>
#include <deque>

#include "device/core/time.h"
#include "device/shot/command/command.h"

namespace axisgate::shot {

class LineTiming {
 public:
  static constexpr std::size_t kTerminator = 2;  // CR LF
  static constexpr std::size_t kKept = 32;       // number of newest exchanges that the turnaround is measured from

  LineTiming(int baud, int axis_count) : baud_(baud), axis_count_(axis_count) {}

  int baud() const { return baud_; }
  Duration time_of(std::size_t bytes) const;  // ten bits a byte
  // Returns the length of the longest reply during a path: Q:SPC with long coordinates.
  std::size_t reply_bytes_max() const;

  void connected() { turnarounds_.clear(); }
  // Called when a line was answered after `latency` by `reply_bytes`, not counting terminators.
  void answered(std::size_t line_bytes, std::size_t reply_bytes, Duration latency);

  // Returns the median, and the maximum, of the time that the newest exchanges took beyond their bytes.
  Duration usual_turnaround() const;
  Duration longest_turnaround() const;

  // Returns the longest time from the first byte written to the last byte of the reply.
  Duration longest_exchange(const Command& command) const;

 private:
  int baud_, axis_count_;
  std::deque<Duration> turnarounds_;  // oldest first
};

}  // namespace axisgate::shot
