// Check whether a caller may use axes: the epochs that the request names, and the decision of the keeper of leases
// (device/use/permission.h).
#pragma once

#include <optional>
#include <vector>

#include "device/core/problem.h"
#include "device/core/tasks.h"
#include "device/shrc203/stage.h"
#include "device/shrc203/state/state_store.h"
#include "device/use/permission.h"

namespace axisgate::shrc203 {

class Rights {
 public:
  Rights(Permission& permission, const StateStore& store, const Tasks& tasks)
      : permission_(permission), store_(store), tasks_(tasks) {}

  // Fails with epoch_passed if the request names another device or frame epoch.
  Result<void> check_epochs(const RequestContext& context) const;
  // Fails like check_epochs(), or with a refusal of the keeper of leases. Call before anything is queued.
  Result<void> authorize(const RequestContext& context, AxisSet axes);
  // Checks the same for a motion, or for a line that sets or starts one. Also fails with emergency_stopped,
  // stop_unconfirmed or stale_setpoint.
  Result<void> authorize_motion(const RequestContext& context, AxisSet axes);
  // Returns the reason why nobody may move these axes now: the latch of an emergency stop, or a late stop that is not
  // confirmed. nullopt if there is no such reason, or `axes` is empty.
  std::optional<Problem> motion_forbidden(AxisSet axes) const;
  // Fails with a refusal of the keeper of leases.
  Result<void> still_authorized(const Use& use) { return permission_.authorize(use, tasks_.now()); }

  // Report to the keeper that a motion has its turn, when it should be over, and that it has left its axes.
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
