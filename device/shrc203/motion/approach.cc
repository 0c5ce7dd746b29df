#include "device/shrc203/motion/approach.h"

#include <algorithm>
#include <utility>

#include "device/shrc203/planning/refill_feasibility.h"

namespace axisgate::shrc203 {
namespace {

Result<std::int64_t> way_of_approach(const AxisMove& move, const Envelope& envelope) {
  if (!move.approach) return 0;
  const auto way = envelope.pulses(move.axis, *move.approach);
  if (way && *way == 0) {
    return fail_on(move.axis, Reason::invalid_request,
                   envelope.label(move.axis) + ": an approach of 0 has no direction",
                   "give the displacement of the approach to the target, such as 50um or -50um");
  }
  return way;
}

// Adds the known speeds to axes without speeds: AP: takes the speeds of all its axes or of none (manual 70)).
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

bool Approaches::has_any(const MoveRequest& request) {
  return std::ranges::any_of(request.moves, [](const AxisMove& move) { return move.approach.has_value(); });
}

Result<PathPlan> Approaches::plan(const MoveRequest& request) const {
  const Positions from = store_.positions();
  const Envelope limits = store_.envelope(request.context);
  auto last = plan_move(request.moves, request.relative, from, limits);
  if (!last) return tl::unexpected(last.error());
  MovePlan first{false, {}};
  last->relative = false;
  for (auto& one : last->axes) {
    const auto asked = std::ranges::find(request.moves, one.axis, &AxisMove::axis);
    const auto way = way_of_approach(*asked, limits);
    if (!way) return tl::unexpected(way.error());
    if (!one.target || !from[static_cast<std::size_t>(one.axis - 1)]) {
      return limits.position_unknown(one.axis);
    }
    one.amount = *one.target;
    const std::int64_t before = *one.target - *way;
    if (auto good = limits.check_target(one.axis, before); !good) return tl::unexpected(good.error());
    first.axes.push_back({one.axis, before, before, one.speed});
  }
  fill_speeds(first, store_.speeds(first.set()));
  fill_speeds(*last, store_.speeds(first.set()));
  PathPlan path{last->set(), {}, {}};
  for (std::size_t axis = 0; axis < kAxisCount; ++axis) path.begin[axis] = from[axis].value_or(0);
  path.segments = {segment_to(first, from), segment_to(*std::move(last), from)};
  if (path.segments[0].end == path.begin) path.segments.erase(path.segments.begin());  // already there
  time_moves(path, store_.speeds(path.axes));
  path.segments.back().from_rest = path.axes.count() > 1 || !check_refill_feasibility(path, timing_);
  return path;
}

Task<void> Approaches::run(LiveMotionPtr live, MoveRequest request) {
  const bool entered = co_await entry_.enter(live, {.reg = Register::ap, .prebuffer = true});
  if (!entered) co_return;
  auto planned = plan(request);
  if (!planned) {
    motions_.refuse(*live, planned.error());
    co_return;
  }
  co_await follower_.follow(live, *std::move(planned));
}

}  // namespace axisgate::shrc203
