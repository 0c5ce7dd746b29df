// Delay between a unit's last completion and READY, measured in earlier motions. The manual does not say whether the
// completion comes before or after the settling (open question completion_before_settle). Not thread safe.
#pragma once

#include <optional>

#include "device/core/time.h"

namespace axisgate::shrc203 {

class ReadyLag {
 public:
  // Returns the delay of the first question after the last completion, so that its reply is READY and comes soon. Zero
  // until a motion has shown that this is too soon.
  Duration first_question() const;

  // Take note of the reply to a question that was asked this long after the last completion.
  void seen_busy(Duration after);
  void seen_ready(Duration after);

 private:
  Duration busy_{};                // longest delay that was too short
  std::optional<Duration> ready_;  // shortest delay that was long enough
  int known_for_ = 0;              // motions since the last new measurement
};

}  // namespace axisgate::shrc203
