#include "device/shrc203/motion/ready_lag.h"

#include <algorithm>

#include "device/shrc203/limits.h"

namespace axisgate::shrc203 {

Duration ReadyLag::first_question() const {
  if (!ready_) return Duration::zero();
  const Duration between = *ready_ - busy_;
  return between <= kReadyLagPrecision ? *ready_ : busy_ + between / 2;
}

void ReadyLag::seen_busy(Duration after) {
  if (after > kReadyLagMax) return;
  busy_ = std::max(busy_, after);
  if (ready_ && *ready_ <= busy_) ready_.reset();
}

// Takes note of READY. A delay that was once too short may be enough later, with another speed or load, so the delay is
// measured again now and then, at the cost of a few questions.
void ReadyLag::seen_ready(Duration after) {
  if (after > kReadyLagMax) return;
  constexpr int kAgain = 256;
  ready_ = std::min(ready_.value_or(after), after);
  if (busy_ >= after || ++known_for_ == kAgain) {
    busy_ = Duration::zero();
    known_for_ = 0;
  }
}

}  // namespace axisgate::shrc203
