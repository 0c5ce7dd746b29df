// Computes when a mill of one speed has executed the bytes that it was sent.
#pragma once

#include <cstdint>
#include <deque>

#include "device/core/time.h"
#include "device/rml1/sending/timeline.h"

namespace axisgate::rml1 {

class Pace {
 public:
  // Each step takes its `duration`, times `slower`. `timeline` outlives this.
  Pace(const Timeline& timeline, float Step::*duration, double slower)
      : timeline_(timeline), duration_(duration), slower_(slower) {}

  // Notes that the job's bytes up to `through` arrive at that time. Both ascend.
  void arrived(std::uint64_t through, TimePoint at);
  // Notes that the bytes after the first `arrived_bytes` ones have not arrived by `now`: each of them takes at least
  // `a_byte` from then on. `now` ascends.
  void not_arrived(std::uint64_t arrived_bytes, Duration a_byte, TimePoint now);
  // Notes that so many bytes have left the mill's buffer by now, whatever its speed is: their last command may be in
  // progress, and those before it have been executed. `now` ascends.
  void has_read(std::uint64_t bytes, TimePoint now);

  // Returns the number of bytes of the job that it has executed. `now` ascends.
  std::uint64_t executed(TimePoint now);
  // Returns when it will have executed so many of the bytes that have arrived.
  TimePoint when(std::uint64_t bytes) const;

 private:
  struct Ending {
    std::uint64_t end = 0;  // bytes
    TimePoint arrived{};
    Duration takes{};
    TimePoint at{};
  };

  void add(std::uint64_t end, TimePoint arrived, Duration takes);

  const Timeline& timeline_;
  float Step::*const duration_;
  const double slower_;
  std::size_t next_ = 0;  // step
  TimePoint free_{};      // when the last step that has arrived ends
  std::uint64_t executed_ = 0;
  std::deque<Ending> unexecuted_;  // in their order
};

}  // namespace axisgate::rml1
