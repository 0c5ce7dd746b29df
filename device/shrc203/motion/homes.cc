#include "device/shrc203/motion/homes.h"

#include <fmt/format.h>

#include <utility>

#include "device/core/guard.h"

namespace axisgate::shrc203 {

Result<void> Homes::check(MotionKind kind, AxisSet axes, const RequestContext& context) const {
  const AxisSet controllable = store_.controllable();
  if (controllable.empty()) return tl::unexpected(store_.not_up());
  if (axes.empty() || !controllable.contains(axes)) {
    return fail(Reason::unknown_axis, fmt::format("{} cannot all be controlled on this unit", to_string(axes)),
                "see `GetDevice`");
  }
  const Envelope limits = store_.envelope(context);
  for (const int axis : axes.list()) {
    if (const auto good = limits.check_stage(axis); !good) return good;
  }
  return kind == MotionKind::return_to_origin ? check_logical_origin(axes, limits) : Result<void>();
}

Result<void> Homes::check_logical_origin(AxisSet axes, const Envelope& limits) const {
  for (const int axis : axes.list()) {
    auto good = limits.check_axis(axis);
    if (good) good = limits.check_homed(axis);
    if (good) good = limits.check_target(axis, 0);
    if (!good) return good;
  }
  return {};
}

Result<void> Homes::check_alone(MotionKind kind, AxisSet axes) const {
  for (const auto& [id, live] : motions_.live()) {
    const bool same = live->motion.kind == kind && live->motion.axes.touches(axes);
    if (!same || !guarded(Guard::one_home_an_axis)) continue;
    return fail(
        Reason::axis_busy,
        fmt::format("{}: motion {} of {} is already running there", to_string(live->motion.axes), id, live->motion.who),
        "wait for its outcome");
  }
  return {};
}

void Homes::home(MotionKind kind, HomeRequest request, StageController::OnStarted started) {
  const AxisSet axes = request.axes.empty() ? store_.controllable() : request.axes;
  auto good = check(kind, axes, request.context);
  if (good) good = rights_.authorize_motion(request.context, axes);
  if (good) good = check_alone(kind, axes);
  if (!good) return started(tl::unexpected(good.error()));
  tasks_.spawn(run(motions_.create(kind, axes, request.context, std::move(started))));
}

Task<void> Homes::run(LiveMotionPtr live) {
  const bool entered = co_await entry_.enter(live, Entry::Writes{});
  if (!entered) co_return;
  const AxisSet axes = live->motion.axes;
  const bool mechanical = live->motion.kind == MotionKind::home;
  Result<void> ready;
  if (!mechanical) ready = check_logical_origin(axes, store_.envelope(live->context));
  if (!ready) {
    motions_.refuse(*live, ready.error());
    co_return;
  }
  for (auto& result : live->motion.results) result.target_pulses = 0;
  // The axes return to the logical origin at F of D:.
  if (!mechanical) ready = co_await speeds_.slow_down(live);
  if (ready) {
    const Command command = mechanical ? commands::home(axes) : commands::return_to_origin(axes);
    co_await start_and_watch(live, command);
  } else {
    motions_.disconnect(*live, ready.error());
  }
  co_await restorer_.restore_after(live);
}

Task<void> Homes::start_and_watch(LiveMotionPtr live, Command command) {
  const auto start = co_await starter_.start(live, command);
  if (start) co_await watch_.run(live, *start);
  if (live->motion.kind != MotionKind::home || live->motion.state != MotionState::succeeded) co_return;
  store_.note_homed(live->motion.axes);
  store_.publish();
}

}  // namespace axisgate::shrc203
