#include "device/shrc203/motion/disarming.h"

#include "device/shrc203/limits.h"

namespace axisgate::shrc203 {

Task<void> Disarming::disarm(LiveMotionPtr live) {
  pending_.remember_scan(live->scan->before, live->scan->trigger);
  for (const TimePoint limit = tasks_.now() + kTriggerRestoreLimit;
       pending_.has_scan() && tasks_.now() < limit && store_.line_works() && !live->life.line_lost();) {
    const bool restored = co_await restorer_.restore_trigger(live->context.who);
    if (restored) break;
    auto pause = tasks_.pause(kTriggerRestorePause);
    co_await pause;
  }
}

}  // namespace axisgate::shrc203
