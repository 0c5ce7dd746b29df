#include "device/shrc203/motion/moves.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "device/core/guard.h"
#include "device/shrc203/planning/travel_time.h"

namespace axisgate::shrc203 {
namespace {

bool any_speed(const MovePlan& plan) {
  return std::ranges::any_of(plan.axes, [](const AxisPlan& axis) { return axis.speed.has_value(); });
}

// Returns the setting command. MP: and AP: take the speeds of all their axes or of none (manual 68), 70)).
Command prebuffer_setter(const MovePlan& plan, commands::Speeds known) {
  auto speeds = speeds_of(plan);
  if (!speeds.empty()) speeds.merge(known);
  return commands::set_setpoint(plan.relative ? Register::mp : Register::ap, amounts_of(plan), speeds);
}

Command execution_setter(const MovePlan& plan) {
  return commands::set_setpoint(plan.relative ? Register::m : Register::a, amounts_of(plan));
}

}  // namespace

Result<MovePlan> Moves::check(const MoveRequest& request) const {
  const bool stationary = !motions_.anything_moves();
  if (Approaches::has_any(request) && stationary) {
    if (const auto both = approaches_.plan(request); !both) return tl::unexpected(both.error());
  }
  return plan_move(request.moves, request.relative, stationary ? store_.positions() : Positions{},
                   store_.envelope(request.context));
}

void Moves::move(MoveRequest request, StageController::OnStarted started) {
  const auto plan = check(request);
  if (!plan) return started(tl::unexpected(plan.error()));
  if (const auto allowed = rights_.authorize_motion(request.context, plan->set()); !allowed) {
    return started(tl::unexpected(allowed.error()));
  }
  auto live = motions_.create(MotionKind::move, plan->set(), request.context, std::move(started));
  if (Approaches::has_any(request)) return tasks_.spawn(approaches_.run(live, std::move(request)));
  tasks_.spawn(run(live, std::move(request)));
}

// Reports whether the move may use prebuffers: those of another running motion must stay as they are.
bool Moves::by_prebuffer(const LiveMotion& live) const {
  return !motions_.others_inside(live) || store_.profile().prebuffer_scope == Scope::axis ||
         !guarded(Guard::prebuffers_are_one_motions);
}

// Plans the move from the present positions, at the motion's turn. Sets the motion's targets.
Result<MovePlan> Moves::plan(LiveMotion& live, const MoveRequest& request) const {
  const Envelope limits = store_.envelope(request.context);
  auto plan = plan_move(request.moves, request.relative, store_.positions(), limits);
  if (!plan) return plan;
  for (std::size_t i = 0; i < plan->axes.size(); ++i) {
    const AxisPlan& one = plan->axes[i];
    live.motion.results[i].target_pulses = one.target;
    if (one.target) continue;
    return limits.position_unknown(one.axis);
  }
  return plan;
}

Task<void> Moves::run(LiveMotionPtr live, MoveRequest request) {
  bool prebuffer = true;
  const std::function<Register()> reg = [&] {
    prebuffer = by_prebuffer(*live);
    if (request.relative) return prebuffer ? Register::mp : Register::m;
    return prebuffer ? Register::ap : Register::a;
  };
  const bool entered = co_await entry_.enter(live, reg);
  if (!entered) co_return;
  const auto planned = plan(*live, request);
  if (!planned) {
    motions_.refuse(*live, planned.error());
    co_return;
  }
  if (any_speed(*planned)) live->speeds_before = store_.speeds(planned->set());
  co_await set_go_watch(live, *planned, prebuffer);
  co_await restorer_.restore_after(live);
}

Task<void> Moves::set_go_watch(LiveMotionPtr live, MovePlan plan, bool by_prebuffer) {
  if (!by_prebuffer && any_speed(plan)) {
    const auto speeds = co_await speeds_.set(live, plan);
    if (!speeds) {
      motions_.end(*live, MotionState::failed, speeds.error());
      co_return;
    }
  }
  const auto setter = by_prebuffer ? prebuffer_setter(plan, store_.speeds(live->motion.axes)) : execution_setter(plan);
  const auto set = co_await starter_.set_and_confirm(live, setter, Lane::motion);
  if (!set) {
    motions_.disconnect(*live, set.error());
    co_return;
  }
  store_.note_speeds(speeds_of(plan));
  const Positions from = store_.positions();
  const auto start = co_await starter_.go(live, by_prebuffer ? live->motion.axes : AxisSet());
  if (!start) {
    motions_.disconnect(*live, start.error());
    co_return;
  }
  if (*start == Start::in_doubt && co_await starter_.start_never_came(live, setter)) {
    motions_.disconnect(*live, Starter::never_came(*live));
    co_return;
  }
  if (const auto travel = travel_time(plan, from, store_.speeds(live->motion.axes));
      travel && *start == Start::accepted) {
    motions_.due(*live, tasks_.now() + *travel);
  }
  co_await watch_.run(live, *start);
}

}  // namespace axisgate::shrc203
