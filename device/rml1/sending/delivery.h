// Simulated sending of a job to a mill of a given speed: when commands arrive, and when they have been executed.
#pragma once

#include <cstddef>
#include <optional>

#include "device/core/time.h"
#include "device/rml1/sending/pace.h"
#include "device/rml1/sending/timeline.h"

namespace axisgate::rml1 {

// Returns the time that the line needs for `bytes` bytes, each with a start bit and a stop bit.
Duration transmit_time(std::size_t bytes, int baud);

class Delivery {
 public:
  // The mill needs `slower` times the `duration` of each step. `window`: how many bytes may be sent beyond those that
  // the mill has executed; nullopt if only the line limits them. `timeline` must outlive this object.
  Delivery(const Timeline& timeline, float Step::*duration, double slower, int baud, std::optional<std::size_t> window)
      : pace_(timeline, duration, slower), baud_(baud), window_(window) {}

  // Sends the bytes from `begin` to `end` of the job, once the bytes before them have left and the window has room.
  // Returns the time of their arrival, counted from the start of sending.
  TimePoint send(std::size_t begin, std::size_t end);
  // Returns the time at which all sent bytes have been executed.
  TimePoint executed() const { return pace_.when(sent_); }

 private:
  Pace pace_;
  const int baud_;
  const std::optional<std::size_t> window_;
  std::size_t sent_ = 0;
  TimePoint now_{};
};

}  // namespace axisgate::rml1
