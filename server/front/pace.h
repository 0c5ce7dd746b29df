// Whether what a client has begun continues: slow is allowed, and endless is not.
#pragma once

#include <cstddef>

#include "device/core/time.h"

namespace axisgate::front {

class Pace {
 public:
  // At least so many bytes in each span.
  struct Least {
    std::size_t bytes = 0;
    Duration span{};
  };

  void begin(TimePoint now) {
    since_ = now;
    bytes_ = 0;
  }
  void came(std::size_t bytes) { bytes_ += bytes; }

  // A span has passed with too little in it. Otherwise the next one begins when one is over.
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
