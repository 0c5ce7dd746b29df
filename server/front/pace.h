// Detection of clients that do not finish a frame or a request: slow is allowed, endless is not.
#pragma once

#include <cstddef>

#include "device/core/time.h"

namespace axisgate::front {

class Pace {
 public:
  // Least number of bytes in each span.
  struct Least {
    std::size_t bytes = 0;
    Duration span{};
  };

  void begin(TimePoint now) {
    since_ = now;
    bytes_ = 0;
  }
  void came(std::size_t bytes) { bytes_ += bytes; }

  // Reports whether too few bytes came in a completed span. Otherwise, the next span begins when one is over.
  bool stalled(const Least& least, TimePoint now) {
    if (now - since_ < least.span) return false;
    if (bytes_ < least.bytes) return true;
    begin(now);
    return false;
  }

 private:
  TimePoint since_{};
  std::size_t bytes_ = 0;
};

}  // namespace axisgate::front
