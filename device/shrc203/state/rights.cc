#include "device/shrc203/state/rights.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "device/core/guard.h"
#include "device/core/spans.h"

namespace axisgate::shrc203 {

namespace {

Problem not_confirmed(const Stop& stop, TimePoint now) {
  if (stop.stale) {
    return {
        .reason = Reason::stale_setpoint,
        .message = fmt::format("a stop left a stale setpoint of {} in the controller, which the next start would run",
                               to_string(stop.axes)),
        .hint = "reset the controller (RESET: or power) before moving these axes"};
  }
  return {.reason = Reason::stop_unconfirmed,
          .message = fmt::format("the {} by {} ({} ago) is not confirmed: nobody has seen the axes obey it",
                                 title_of(stop), fmt::join(stop.callers, ", "), for_people(now - stop.asked)),
          .hint = "try again once it is confirmed; `GetDevice` shows the open stops"};
}

}  // namespace

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
  return still_authorized({context.who, context.lease, axes, 0, context.session});
}

Result<void> Rights::authorize_motion(const RequestContext& context, AxisSet axes) {
  if (auto forbidden = motion_forbidden(axes)) return tl::unexpected(*std::move(forbidden));
  return authorize(context, axes);
}

std::optional<Problem> Rights::motion_forbidden(AxisSet axes) const {
  const State& state = store_.state();
  if (axes.empty()) return std::nullopt;
  if (state.emergency) {
    return Problem{
        .reason = Reason::emergency_stopped,
        .message = fmt::format("{} requested an emergency stop {} ago, and nothing moves until it is cleared",
                               state.emergency->who, for_people(tasks_.now() - state.emergency->at)),
        .hint = "make sure that motion is safe, then clear the errors of all axes: `ClearErrors`"};
  }
  for (const Stop& stop : state.open_stops) {
    if (!stop.late || !stop.axes.touches(axes) || !guarded(Guard::open_stop_refuses_motion)) continue;
    return not_confirmed(stop, tasks_.now());
  }
  return std::nullopt;
}

}  // namespace axisgate::shrc203
