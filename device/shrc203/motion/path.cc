// Paths: checked, then run at their turn by path_run.h.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "device/shrc203/controller_impl.h"
#include "device/shrc203/motion/path_run.h"
#include "device/shrc203/planning/feeding.h"

namespace axisgate::shrc203 {

// Where the axes and their speeds are known, which they are not always before the gate has been passed.
Result<PathPlan> Controller::Impl::plan_feasible_path(const PathRequest& request) const {
  const auto waits = std::ranges::find_if(request.segments, [](const Segment& one) { return one.inputs.has_value(); });
  if (waits != request.segments.end()) {
    const auto allowed = may_wait_for_inputs(fmt::format("segment {}", waits - request.segments.begin() + 1));
    if (!allowed) return tl::unexpected(allowed.error());
  }
  auto plan = plan_path(request, positions_of(state_), envelope(request.context));
  if (!plan || !known_speeds(AxisSet::of(plan->axes.lowest())).contains(plan->axes.lowest())) return plan;
  const auto feasible = check_feeding(*plan, line_.pace());
  if (!feasible) return tl::unexpected(feasible.error());
  return plan;
}

void Controller::Impl::run_path(PathRequest request, OnStarted started) {
  const auto plan = plan_feasible_path(request);
  if (!plan) {
    started(tl::unexpected(plan.error()));
    return;
  }
  if (const auto allowed = may_use(request.context, plan->axes); !allowed) {
    started(tl::unexpected(allowed.error()));
    return;
  }
  auto live = create_motion(MotionKind::path, plan->axes, request.context, std::move(started));
  live->motion.segments_total = static_cast<int>(plan->segments.size());
  executor_.spawn(run_path_motion(live, std::move(request), plan->segments.front().reg()));
}

Task<void> Controller::Impl::run_path_motion(LiveMotionPtr live, PathRequest request, Register reg) {
  auto ready = co_await enter_gate(live, true);
  if (ready) ready = co_await prepare(live, reg);
  if (!ready) {
    end_motion(live, ready.error().reason == Reason::stopped ? MotionState::stopped : MotionState::failed,
               ready.error());
    co_return;
  }
  auto plan = plan_feasible_path(request);
  if (!plan) {
    end_motion(live, MotionState::failed, plan.error());
    co_return;
  }
  co_await follow_path(live, *std::move(plan));
}

// From READY to the outcome; the speeds that it changes are the old ones again then.
Task<void> Controller::Impl::follow_path(LiveMotionPtr live, PathPlan plan) {
  for (auto& result : live->motion.results) {
    result.target_pulses = plan.segments.back().end[static_cast<std::size_t>(result.axis - 1)];
  }
  const Speeds before = known_speeds(plan.axes);
  live->keeps_gate = live->keeps_gate || std::ranges::any_of(plan.segments, [](const SegmentPlan& segment) {
                       return !speeds_of(segment.move).empty();
                     });
  live->chains = plan.segments.size() > 1;
  PathRun run(*this, live, std::move(plan));
  co_await run.run();
  if (live->scan) co_await disarm(live);
  co_await restore_speeds(live, before);
}

}  // namespace axisgate::shrc203
