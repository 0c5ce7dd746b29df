// When a mill of one speed has executed what it was sent.
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

  // The job's bytes up to `through` have arrived then. Both ascend.
  void arrived(std::uint64_t through, TimePoint at);
  // What is behind so many bytes has not arrived by `now`: each byte of it takes `a_byte` from then on, at least.
  // `now` ascends.
  void not_arrived(std::uint64_t behind, Duration a_byte, TimePoint now);
  // So many bytes have left the mill's buffer by now, whatever its speed is: the command that they end with may be
  // under way, and those before it have been executed. `now` ascends.
  void has_read(std::uint64_t bytes, TimePoint now);

  // How many bytes of the job it has executed. `now` ascends.
  std::uint64_t executed(TimePoint now);
  // When it will have executed so many of those that have arrived.
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
  std::deque<Ending> under_way_;  // in their order
};

}  // namespace axisgate::rml1
