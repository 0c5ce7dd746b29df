#include "device/shrc203/motion/paths.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "device/core/guard.h"
#include "device/shrc203/planning/refill_feasibility.h"

namespace axisgate::shrc203 {

Task<void> PathFollower::follow(LiveMotionPtr live, PathPlan plan) {
  for (auto& result : live->motion.results) {
    result.target_pulses = plan.segments.back().end[static_cast<std::size_t>(result.axis - 1)];
  }
  const bool sets_speeds =
      std::ranges::any_of(plan.segments, [](const SegmentPlan& segment) { return !speeds_of(segment.move).empty(); });
  if (live->scan || sets_speeds) live->speeds_before = store_.speeds(plan.axes);
  live->segments = static_cast<int>(plan.segments.size());
  PathRun run(parts_, live, std::move(plan));
  co_await run.run();
  if (live->scan) co_await disarming_.disarm(live);
  co_await restorer_.restore_after(live);
}

Result<void> may_wait_for_inputs(const Profile& profile, std::string_view what) {
  if (profile.wait_for_inputs || !guarded(Guard::inputs_start_nothing)) return {};
  return fail(Reason::not_allowed,
              fmt::format("{} lets an input pin start a motion, even while somebody's hands are at the stage", what),
              "an administrator may allow it for this device: wait_for_inputs = true");
}

Result<PathPlan> Paths::plan(const PathRequest& request) const {
  const auto waits = std::ranges::find_if(request.segments, [](const Segment& one) { return one.inputs.has_value(); });
  if (waits != request.segments.end()) {
    const auto which = fmt::format("segment {}", waits - request.segments.begin() + 1);
    if (const auto allowed = may_wait_for_inputs(store_.profile(), which); !allowed) {
      return tl::unexpected(allowed.error());
    }
  }
  auto plan = plan_path(request, store_.positions(), store_.envelope(request.context));
  if (!plan || !store_.speeds_known(AxisSet::of(plan->axes.lowest()))) return plan;
  const auto feasible = check_refill_feasibility(*plan, timing_);
  if (!feasible) return tl::unexpected(feasible.error());
  return plan;
}

void Paths::run(PathRequest request, StageController::OnStarted started) {
  const auto planned = plan(request);
  if (!planned) return started(tl::unexpected(planned.error()));
  if (const auto allowed = rights_.authorize_motion(request.context, planned->axes); !allowed) {
    return started(tl::unexpected(allowed.error()));
  }
  auto live = motions_.create(MotionKind::path, planned->axes, request.context, std::move(started));
  live->motion.segments_total = static_cast<int>(planned->segments.size());
  tasks_.spawn(run_at_turn(live, std::move(request), planned->segments.front().reg()));
}

Task<void> Paths::run_at_turn(LiveMotionPtr live, PathRequest request, Register reg) {
  const bool entered = co_await entry_.enter(live, {.reg = reg, .prebuffer = true});
  if (!entered) co_return;
  auto planned = plan(request);
  if (!planned) {
    motions_.refuse(*live, planned.error());
    co_return;
  }
  co_await follower_.follow(live, *std::move(planned));
}

}  // namespace axisgate::shrc203
