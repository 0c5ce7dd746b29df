// Whether a caller may use axes: the epochs that the request names, and what the keeper of leases says
// (device/stage/permission.h).
#pragma once

#include <optional>
#include <vector>

#include "device/core/problem.h"
#include "device/core/tasks.h"
#include "device/shrc203/stage.h"
#include "device/shrc203/state/state_store.h"
#include "device/stage/permission.h"

namespace axisgate::shrc203 {

class Rights {
 public:
  Rights(Permission& permission, const StateStore& store, const Tasks& tasks)
      : permission_(permission), store_(store), tasks_(tasks) {}

  // epoch_passed, where the request was meant for another.
  Result<void> check_epochs(const RequestContext& context) const;
  // Also what the keeper of leases refuses: before anything is queued.
  Result<void> authorize(const RequestContext& context, AxisSet axes);
  // The same for a motion, or a line that sets or starts one. Also emergency_stopped, stop_unconfirmed, stale_setpoint.
  Result<void> authorize_motion(const RequestContext& context, AxisSet axes);
  // Why nobody may move these axes now: the latch of an emergency stop, or a stop that was not seen to be obeyed.
  // nullopt if somebody may, and for no axes.
  std::optional<Problem> motion_forbidden(AxisSet axes) const;
  // What the keeper alone refuses.
  Result<void> still_authorized(const Use& use) { return permission_.authorize(use, tasks_.now()); }

  // A motion has its turn, should be over by then, or has left its axes.
  void begin(const Use& use, const Motion& motion) { permission_.begin(use, occupation_by(motion), tasks_.now()); }
  void due(MotionId motion, TimePoint over) { permission_.due(motion, over); }
  void end(MotionId motion) { permission_.end(motion, tasks_.now()); }
  void stop_asked(const Use& stop, const std::vector<Use>& waiting) {
    permission_.stop_asked(stop, waiting, tasks_.now());
  }

 private:
  Permission& permission_;
  const StateStore& store_;
  const Tasks& tasks_;
};

}  // namespace axisgate::shrc203
