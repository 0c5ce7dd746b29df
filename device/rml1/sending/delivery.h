// Models a job on its way to a mill of one speed: when its commands arrive, and when they have been executed.
#pragma once

#include <cstddef>
#include <optional>

#include "device/core/time.h"
#include "device/rml1/sending/pace.h"
#include "device/rml1/sending/timeline.h"

namespace axisgate::rml1 {

// Returns the time of so many bytes on the line, each with start bit and stop bit.
Duration transmit_time(std::size_t bytes, int baud);

class Delivery {
 public:
  // Each step takes the mill its `duration`, times `slower`. `window`: number of bytes that may be ahead of what it has
  // executed; nullopt if the line alone limits them.
  Delivery(const Timeline& timeline, float Step::*duration, double slower, int baud, std::optional<std::size_t> window)
      : pace_(timeline, duration, slower), baud_(baud), window_(window) {}

  // Sends the next command, which leaves once the command before has left and the window has room. Returns when it
  // arrives, counted from the start.
  TimePoint send(std::size_t begin, std::size_t end);
  // Returns when all that was sent has been executed.
  TimePoint executed() const { return pace_.when(sent_); }

 private:
  Pace pace_;
  const int baud_;
  const std::optional<std::size_t> window_;
  std::size_t sent_ = 0;
  TimePoint now_{};
};

}  // namespace axisgate::rml1
