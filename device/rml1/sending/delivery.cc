#include "device/rml1/sending/delivery.h"

#include <algorithm>
#include <chrono>

namespace axisgate::rml1 {

Duration transmit_time(std::size_t bytes, int baud) {
  constexpr int kBitsAByte = 10;
  return std::chrono::duration_cast<Duration>(
      std::chrono::duration<double>(static_cast<double>(bytes) * kBitsAByte / baud));
}

TimePoint Delivery::send(std::size_t begin, std::size_t end) {
  if (window_ && end > *window_) now_ = std::max(now_, pace_.when(std::min(end - *window_, begin)));
  pace_.executed(now_);
  now_ += transmit_time(end - begin, baud_);
  pace_.arrived(end, now_);
  sent_ = end;
  return now_;
}

}  // namespace axisgate::rml1
