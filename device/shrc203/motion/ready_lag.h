// How long after its last axis number a unit is READY, as earlier motions have shown: the manual does not say whether
// the number comes before or after the settling (open question completion_before_settle). No threads.
#pragma once

#include <optional>

#include "device/core/time.h"

namespace axisgate::shrc203 {

class ReadyLag {
 public:
  // How long the first question waits after the last axis number, so that its answer is READY and comes soon. Nothing,
  // until a motion has shown that this is too soon.
  Duration first_question() const;

  // What a question so long after the last axis number has shown.
  void seen_busy(Duration after);
  void seen_ready(Duration after);

 private:
  Duration busy_{};                // the longest that was too soon
  std::optional<Duration> ready_;  // the shortest that was not
  int known_for_ = 0;              // motions since it was sought
};

}  // namespace axisgate::shrc203
