// Times at which a mill of a given speed has executed the bytes that were sent to it.
#pragma once

#include <cstdint>
#include <deque>

#include "device/core/time.h"
#include "device/rml1/sending/timeline.h"

namespace axisgate::rml1 {

class Pace {
 public:
  // The mill needs `slower` times the `duration` of each step. `timeline` must outlive this object.
  Pace(const Timeline& timeline, float Step::*duration, double slower)
      : timeline_(timeline), duration_(duration), slower_(slower) {}

  // Notes that the first `through` bytes of the job have arrived at the time `at`. Neither argument may decrease from
  // call to call.
  void arrived(std::uint64_t through, TimePoint at);
  // Notes that only the first `arrived_bytes` bytes have arrived by `now`. The later bytes arrive one after another
  // from `now` on, at intervals of at least `a_byte`. `now` must never decrease.
  void not_arrived(std::uint64_t arrived_bytes, Duration a_byte, TimePoint now);
  // Notes that the first `bytes` bytes have left the mill's buffer by `now`, whatever the mill's speed is: the last
  // command in them may be in progress, and all commands before it have been executed. `now` must never decrease.
  void has_read(std::uint64_t bytes, TimePoint now);

  // Returns the number of bytes of the job that the mill has executed by `now`. `now` must never decrease.
  std::uint64_t executed(TimePoint now);
  // Returns the time at which the mill has executed the first `bytes` bytes, which must have arrived. Returns
  // TimePoint{} if it has executed them already.
  TimePoint when(std::uint64_t bytes) const;

 private:
  // An Ending is the end of a command that has not been executed.
  struct Ending {
    std::uint64_t end = 0;  // in bytes of the job
    TimePoint arrived{};
    Duration takes{};
    TimePoint at{};  // when the command has been executed
  };

  void add(std::uint64_t end, TimePoint arrived, Duration takes);

  const Timeline& timeline_;
  float Step::*const duration_;
  const double slower_;
  std::size_t next_ = 0;  // index of the next step to arrive
  TimePoint free_{};      // end of the last step that has arrived
  std::uint64_t executed_ = 0;
  std::deque<Ending> unexecuted_;  // in the order of the job
};

}  // namespace axisgate::rml1
