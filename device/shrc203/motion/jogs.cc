#include "device/shrc203/motion/jogs.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "device/core/guard.h"
#include "device/shrc203/motion/jog_bound.h"

namespace axisgate::shrc203 {
namespace {

using JogAxes = std::vector<JogRequest::Axis>;

tl::unexpected<Problem> near_bound(const Envelope& envelope, int axis, std::int64_t bound) {
  return fail_on(axis, Reason::outside_travel,
                 fmt::format("{} is too near to its travel limit of {} to jog further", envelope.label(axis),
                             envelope.as_text(axis, bound)),
                 "move it there, or jog it more slowly");
}

// Returns the requested speeds in pulses/s. Checks all but the start speeds, which may be unknown before the motion's
// turn.
Result<std::map<int, std::int64_t>> check_jog(const JogAxes& axes, const Envelope& envelope) {
  if (axes.empty()) return fail(Reason::invalid_request, "no axis was named", "name an axis and a direction");
  AxisSet named;
  std::map<int, std::int64_t> speeds;
  for (const auto& [axis, direction, speed] : axes) {
    if (auto good = envelope.check_axis(axis); !good) return tl::unexpected(good.error());
    if (auto good = envelope.check_homed(axis); !good) return tl::unexpected(good.error());
    if (named.has(axis)) return fail_on(axis, Reason::invalid_request, envelope.label(axis) + " is named twice");
    named.add(axis);
    if (!speed) continue;
    const auto asked = envelope.speed(axis, *speed);
    if (!asked) return tl::unexpected(asked.error());
    speeds[axis] = *asked;
  }
  return speeds;
}

AxisSet axes_of(const JogAxes& axes) {
  AxisSet set;
  for (const auto& one : axes) set.add(one.axis);
  return set;
}

Command jog_setter(const Jog& jog, AxisSet axes) {
  commands::Amounts directions;
  for (const int axis : axes.list()) directions[axis] = jog.directions.at(axis);
  return commands::set_jog(directions);
}

}  // namespace

MotionId Jogs::jog(JogRequest request, StageController::OnStarted started) {
  const auto speeds = check_jog(request.axes, store_.envelope(request.context));
  const AxisSet axes = axes_of(request.axes);
  auto good = speeds ? rights_.authorize_motion(request.context, axes) : tl::unexpected(speeds.error());
  if (!good) {
    started(tl::unexpected(good.error()));
    return 0;
  }
  auto live = motions_.create(MotionKind::jog, axes, request.context, std::move(started));
  live->jog.emplace(tasks_.executor());
  live->jog->renewed = tasks_.now();
  live->jog->epoch = store_.state().device_epoch;
  live->jog->speeds = *speeds;
  for (const auto& one : request.axes) live->jog->directions[one.axis] = one.direction;
  tasks_.spawn(run(live, std::move(request)));
  tasks_.spawn(watchdog_.run(live));
  return live->motion.id;
}

Result<void> Jogs::renew(MotionId id, const JogAxes& speeds) {
  const auto live = motions_.find_live(id);
  if (!live || !live->jog) {
    return fail(Reason::not_found, fmt::format("the jog {} has ended", id), "see its outcome: GetMotion");
  }
  const Envelope limits = store_.envelope(live->context);
  for (const auto& [axis, direction, speed] : speeds) {
    if (!live->motion.axes.has(axis) || !speed) {
      return fail(Reason::unknown_axis, fmt::format("axis {} is none of this jog's, or has no speed", axis),
                  "name axes of the jog, each with its new speed");
    }
    const auto asked = limits.speed(axis, *speed);
    if (!asked) return tl::unexpected(asked.error());
    live->jog->speeds[axis] = *asked;
  }
  live->jog->renewed = tasks_.now();
  live->jog->changed.notify();
  return {};
}

void Jogs::end(MotionId id, std::optional<Problem> why) {
  if (const auto live = motions_.find_live(id)) motions_.end_jog(*live, std::move(why));
}

// Returns the speeds to lower first: those of axes whose own S exceeds the speed that the caller may use.
Result<MovePlan> Jogs::plan(LiveMotion& live, const JogRequest& request) const {
  const Envelope limits = store_.envelope(live.context);
  if (const auto checked = check_jog(request.axes, limits); !checked) return tl::unexpected(checked.error());
  MovePlan slower;
  for (const int axis : live.motion.axes.list()) {
    const auto cap = limits.speed_cap(axis);
    if (!cap) return tl::unexpected(cap.error());
    const auto bound = limits.bound(axis, live.jog->directions.at(axis));
    if (!bound) return tl::unexpected(bound.error());
    const SpeedSetting own = store_.speeds(AxisSet::of(axis)).at(axis);
    const std::int64_t start = std::min(own.minimum, cap->value_or(own.minimum));
    if (start < own.minimum) {
      slower.axes.push_back({axis, 0, {}, SpeedSetting{start, own.maximum, own.acceleration_ms}});
    }
    live.jog->fastest[axis] = start;
    const auto stop_at = JogBound(store_, live, tasks_.now()).stop_at(axis);
    if (!stop_at || *stop_at <= tasks_.now()) return near_bound(limits, axis, *bound);
  }
  return slower;
}

Task<void> Jogs::run(LiveMotionPtr live, JogRequest request) {
  const bool entered = co_await entry_.enter(live, {.reg = Register::j, .prebuffer = false});
  if (!entered) co_return;
  auto slower = plan(*live, request);
  if (!slower) {
    motions_.refuse(*live, slower.error());
    co_return;
  }
  live->speeds_before = store_.speeds(live->motion.axes);  // JD: and D: change them
  co_await start(live, *std::move(slower));
  live->jog->changed.notify();
  if (store_.state().link != LinkState::down) {
    // JD: may have overwritten F (manual 93), note), so F is unknown until it is read.
    store_.forget_speeds(live->motion.axes);
    const auto read = co_await reader_.read_speeds(live->context.who);
    if (!read) store_.unsettle();
  }
  co_await restorer_.restore_after(live);
}

// Sets, starts and watches the jog, like a move.
Task<void> Jogs::start(LiveMotionPtr live, MovePlan slower) {
  if (!slower.axes.empty()) {
    const auto lowered = co_await speeds_.set(live, slower);
    if (!lowered) {
      motions_.disconnect(*live, lowered.error());
      co_return;
    }
    store_.note_speeds(speeds_of(slower));
  }
  const Command setter = jog_setter(*live->jog, live->motion.axes);
  const auto set = co_await starter_.set_and_confirm(live, setter, Lane::motion);
  if (!set) {
    motions_.disconnect(*live, set.error());
    co_return;
  }
  live->jog->begun = tasks_.now();
  motions_.jog_changed(*live, JogEvent::begun);
  const auto gone = co_await starter_.go(live, {});
  if (!gone) {
    motions_.disconnect(*live, gone.error());
    // The NG may belong to another line, and a jog that runs despite NG would never end.
    stops_.stop(live->motion.axes, {.who = "the gateway: a jog that was refused"});
    co_return;
  }
  if (*gone == Start::in_doubt && co_await starter_.start_never_came(live, setter)) {
    motions_.disconnect(*live, Starter::never_came(*live));
    co_return;
  }
  live->jog->changed.notify();
  co_await watch_.run(live, *gone);
}

}  // namespace axisgate::shrc203
