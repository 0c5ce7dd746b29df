// Targets that are always come to from the same side, so that the play of a screw does not count (backlash): two moves,
// of which one axis has the second in its prebuffer (manual 2. About double buffer) while the first runs. Several axes
// come to rest between: whether each would go on by itself is open (README: chain_step_on).
#include <algorithm>
#include <utility>

#include "device/shrc203/controller_impl.h"
#include "device/shrc203/motion/path_run.h"
#include "device/shrc203/planning/feeding.h"

namespace axisgate::shrc203 {
namespace {

Result<std::int64_t> way_of_approach(const AxisMove& move, const Envelope& envelope) {
  if (!move.approach) return 0;
  const auto way = envelope.pulses(move.axis, *move.approach);
  if (way && *way == 0) {
    return fail_on(move.axis, Reason::invalid_request,
                   envelope.label(move.axis) + ": an approach of 0 comes from no side",
                   "give the way by which the axis comes to its target, such as 50um or -50um");
  }
  return way;
}

// AP: takes the speeds of all its axes or of none (manual 70)).
void fill_speeds(MovePlan& move, const std::map<int, SpeedSetting>& known) {
  if (speeds_of(move).empty()) return;
  for (auto& one : move.axes) {
    if (!one.speed && known.contains(one.axis)) one.speed = known.at(one.axis);
  }
}

SegmentPlan segment_to(MovePlan move, const Positions& from) {
  SegmentPlan segment;
  for (std::size_t axis = 0; axis < kAxisCount; ++axis) segment.end[axis] = from[axis].value_or(0);
  for (const auto& one : move.axes) segment.end[static_cast<std::size_t>(one.axis - 1)] = *one.target;
  segment.move = std::move(move);
  return segment;
}

}  // namespace

bool Controller::Impl::approaches(const MoveRequest& request) {
  return std::ranges::any_of(request.moves, [](const AxisMove& move) { return move.approach.has_value(); });
}

Result<PathPlan> Controller::Impl::plan_approach(const MoveRequest& request) const {
  const Positions from = positions_of(state_);
  const Envelope limits = envelope(request.context);
  auto last = plan_move(request.moves, request.relative, from, limits);
  if (!last) return tl::unexpected(last.error());
  MovePlan first{false, {}};
  last->relative = false;
  for (auto& one : last->axes) {
    const auto asked = std::ranges::find(request.moves, one.axis, &AxisMove::axis);
    const auto way = way_of_approach(*asked, limits);
    if (!way) return tl::unexpected(way.error());
    if (!one.target || !from[static_cast<std::size_t>(one.axis - 1)]) {
      return fail_on(one.axis, Reason::position_unknown, "where " + limits.label(one.axis) + " stands is not known",
                     "wait until the device is up");
    }
    one.amount = *one.target;
    const std::int64_t before = *one.target - *way;
    if (auto good = limits.check_target(one.axis, before); !good) return tl::unexpected(good.error());
    first.axes.push_back({one.axis, before, before, one.speed});
  }
  fill_speeds(first, known_speeds(first.set()));
  fill_speeds(*last, known_speeds(first.set()));
  PathPlan path{last->set(), {}, {}};
  for (std::size_t axis = 0; axis < kAxisCount; ++axis) path.begin[axis] = from[axis].value_or(0);
  path.segments = {segment_to(first, from), segment_to(*std::move(last), from)};
  if (path.segments[0].end == path.begin) path.segments.erase(path.segments.begin());  // it stands there already
  time_moves(path, known_speeds(path.axes));
  path.segments.back().from_rest = path.axes.count() > 1 || !check_feeding(path, line_.pace());
  return path;
}

Task<void> Controller::Impl::run_approach(LiveMotionPtr live, MoveRequest request) {
  auto ready = co_await enter_gate(live, true);
  if (ready) ready = co_await prepare(live, Register::ap);
  if (!ready) {
    end_motion(live, ready.error().reason == Reason::stopped ? MotionState::stopped : MotionState::failed,
               ready.error());
    co_return;
  }
  auto plan = plan_approach(request);
  if (!plan) {
    end_motion(live, MotionState::failed, plan.error());
    co_return;
  }
  co_await follow_path(live, *std::move(plan));
}

}  // namespace axisgate::shrc203
