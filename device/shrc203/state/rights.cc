#include "device/shrc203/state/rights.h"

#include <fmt/format.h>

#include "device/core/guard.h"

namespace axisgate::shrc203 {

Result<void> Rights::check_epochs(const RequestContext& context) const {
  const State& state = store_.state();
  const auto passed = [](std::uint64_t meant, std::uint64_t present) { return meant != 0 && meant != present; };
  if (passed(context.device_epoch, state.device_epoch) && guarded(Guard::passed_epochs_refused)) {
    return fail(Reason::epoch_passed,
                fmt::format("the request is of device epoch {}, and this is {}: the controller may have restarted "
                            "meanwhile, and places may be others",
                            context.device_epoch, state.device_epoch),
                "look where the axes are, find their origin where it matters, and take the epoch from Device");
  }
  if (passed(context.frame_epoch, state.frame_epoch) && guarded(Guard::passed_frames_refused)) {
    return fail(Reason::epoch_passed,
                fmt::format("the request is of frame epoch {}, and this is {}: somebody has set coordinates anew (R:, "
                            "RC:, PSET:), or the controller has restarted",
                            context.frame_epoch, state.frame_epoch),
                "look where the axes are, reckon the targets anew, and take the epoch from Device");
  }
  return {};
}

Result<void> Rights::may_use(const RequestContext& context, AxisSet axes) {
  if (const auto good = check_epochs(context); !good) return good;
  return still_may_use({context.who, context.lease, axes, 0});
}

}  // namespace axisgate::shrc203
