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
                            "meanwhile, and positions may have changed",
                            context.device_epoch, state.device_epoch),
                "read the positions, home the axes where it matters, and take the epoch from Device");
  }
  if (passed(context.frame_epoch, state.frame_epoch) && guarded(Guard::passed_frames_refused)) {
    return fail(Reason::epoch_passed,
                fmt::format("the request is of frame epoch {}, and this is {}: coordinates were set (R:, "
                            "RC:, PSET:), or the controller has restarted",
                            context.frame_epoch, state.frame_epoch),
                "read the positions, compute the targets again, and take the epoch from Device");
  }
  return {};
}

Result<void> Rights::authorize(const RequestContext& context, AxisSet axes) {
  if (const auto good = check_epochs(context); !good) return good;
  return still_authorized({context.who, context.lease, axes, 0});
}

}  // namespace axisgate::shrc203
