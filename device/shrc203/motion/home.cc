// Origin returns, mechanical (HRT:) and logical (ZRT:): one line sets them going, one number an axis ends them.
#include <fmt/format.h>

#include "device/core/guard.h"
#include "device/shrc203/controller_impl.h"

namespace axisgate::shrc203 {

void Controller::Impl::home(MotionKind kind, HomeRequest request, OnStarted started) {
  const AxisSet axes = request.axes.empty() ? state_.controllable() : request.axes;
  if (axes.empty() || !state_.controllable().contains(axes)) {
    started(fail(state_.controllable().empty() ? Reason::link_down : Reason::unknown_axis,
                 state_.controllable().empty()
                     ? "the device is not up: " + state_.link_problem
                     : fmt::format("{} cannot all be controlled on this unit", to_string(axes)),
                 "see `axisctl status`"));
    return;
  }
  for (const int axis : axes.list()) {
    const auto good = envelope(request.context).check_stage(axis);
    if (!good) return started(tl::unexpected(good.error()));
  }
  if (kind == MotionKind::return_to_origin) {
    const auto good = check_logical_origin(axes, envelope(request.context));
    if (!good) return started(tl::unexpected(good.error()));
  }
  if (const auto allowed = may_use(request.context, axes); !allowed) {
    started(tl::unexpected(allowed.error()));
    return;
  }
  for (const auto& [id, live] : live_) {
    const bool same = live->motion.kind == kind && live->motion.axes.touches(axes);
    if (!same || !guarded(Guard::one_home_an_axis)) continue;
    started(fail(Reason::axis_busy,
                 fmt::format("{}: motion {} of {} is already under way there", to_string(live->motion.axes), id,
                             live->motion.who),
                 "wait for its outcome"));
    return;
  }
  auto live = create_motion(kind, axes, request.context, std::move(started));
  executor_.spawn(run_home(live));
}

Result<void> Controller::Impl::check_logical_origin(AxisSet axes, const Envelope& limits) const {
  for (const int axis : axes.list()) {
    auto good = limits.check_axis(axis);
    if (good) good = limits.check_homed(axis);
    if (good) good = limits.check_target(axis, 0);
    if (!good) return good;
  }
  return {};
}

Task<void> Controller::Impl::run_home(LiveMotionPtr live) {
  auto ready = co_await enter_gate(live, false);
  if (ready) ready = co_await prepare(live, Register::none);
  if (ready && live->motion.kind == MotionKind::return_to_origin) {
    ready = check_logical_origin(live->motion.axes, envelope(live->context));
  }
  if (!ready) {
    end_motion(live, ready.error().reason == Reason::stopped ? MotionState::stopped : MotionState::failed,
               ready.error());
    co_return;
  }
  const bool mechanical = live->motion.kind == MotionKind::home;
  for (auto& result : live->motion.results) result.target_pulses = 0;
  // Back to the logical origin the axes run at F of D:.
  const Speeds before = known_speeds(live->motion.axes);
  if (!mechanical) ready = co_await slow_down(live);
  if (!ready) {
    end_motion(live, live->stop_requested ? MotionState::stopped : MotionState::failed, ready.error());
    co_await restore_speeds(live, before);
    co_return;
  }
  const AxisSet axes = live->motion.axes;
  const Command start = mechanical ? commands::home(axes) : commands::return_to_origin(axes);
  co_await start_and_watch(live, start);
  if (mechanical && live->motion.state == MotionState::succeeded) {
    for (const int axis : live->motion.axes.list()) {
      state_.axis(axis).homed = true;
      ++state_.axis(axis).homings;
    }
    publish_state();
  }
  co_await restore_speeds(live, before);
}

Task<void> Controller::Impl::start_and_watch(LiveMotionPtr live, Command start) {
  if (live->stop_requested && guarded(Guard::stop_before_preparing)) {
    end_motion(live, MotionState::stopped,
               Problem{.reason = Reason::stopped, .message = "stopped by " + live->stopped_by});
    co_return;
  }
  auto request = motion_request(*live, start, Lane::motion);
  request.completes = live->motion.axes;
  live->wrote = true;
  auto pending = line_.exchange(std::move(request), now_);
  const auto result = co_await pending;
  bool in_doubt = result.in_doubt();
  if (result.refused() && guarded(Guard::refused_start_looked_at)) in_doubt = co_await moves_all_the_same(live);
  if (result.refused() && !in_doubt) {
    const auto why = co_await explain_refusal(start, live->motion.axes, live->context.who);
    end_motion(live, MotionState::failed, why);
    co_return;
  }
  if (!result.accepted() && !in_doubt) {
    end_motion(live, live->stop_requested ? MotionState::stopped : MotionState::failed, *result.problem);
    co_return;
  }
  if (result.accepted()) mark_running(live);
  co_await watch(live, in_doubt);
}

}  // namespace axisgate::shrc203
