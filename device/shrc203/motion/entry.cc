#include "device/shrc203/motion/entry.h"

#include <fmt/format.h>

#include <utility>

#include "device/core/guard.h"
#include "device/shrc203/command/refusals.h"
#include "device/shrc203/limits.h"

namespace axisgate::shrc203 {

Task<bool> Entry::enter(LiveMotionPtr live, Writes writes) {
  auto ready = co_await motions_.enter(live, writes.prebuffer);
  if (ready) ready = co_await prepare(live, writes.reg);
  if (!ready) motions_.refuse(*live, ready.error());
  co_return ready.has_value();
}

Task<bool> Entry::enter(LiveMotionPtr live, std::function<Register()> reg) {
  auto ready = co_await motions_.enter(live, false);
  if (ready) ready = co_await prepare(live, reg());
  if (!ready) motions_.refuse(*live, ready.error());
  co_return ready.has_value();
}

Task<Result<void>> Entry::prepare(LiveMotionPtr live, Register reg) {
  if (!store_.line_works()) co_return tl::unexpected(store_.not_up());
  const AxisSet axes = live->motion.axes;
  // The divisions may have changed while the motion waited.
  for (const int axis : axes.list()) {
    const auto good = store_.envelope(live->context).check_stage(axis);
    if (!good) co_return good;
  }
  auto ready = co_await wait_for_axes(live);
  if (ready) ready = co_await restore_pending(live);
  if (!ready) co_return ready;
  if (!registers_.known() || registers_.any()) {
    const auto cleared = co_await clear_stale_setpoints(live, reg);
    if (!cleared) co_return cleared;
  }
  if (const auto problem = error_shown(axes, store_.state())) co_return tl::unexpected(*problem);
  ready = co_await explainer_.check_excitation(live->excited, live->context.who);
  if (ready) ready = co_await reader_.learn_speeds(axes, live->context.who);
  co_return ready;
}

namespace {

// Returns why a motion must not start yet. `busy`: axis that moves; 0 if only the completions of `outstanding` are
// missing.
Problem late(int busy, AxisSet outstanding) {
  if (busy != 0) {
    return {.reason = Reason::axis_busy,
            .message = fmt::format("axis {} did not stop in the time allowed", busy),
            .hint = "wait until it is stationary, or stop it: `Stop`",
            .axis = busy};
  }
  return {.reason = Reason::completion_outstanding,
          .message = "the completion of an earlier motion may still come, and would be taken for this one's",
          .hint = "try again, and allow at least one second more",
          .axis = outstanding.list().front()};
}

}  // namespace

// Waits until the axes are stationary and no late completion is possible.
Task<Result<void>> Entry::wait_for_axes(LiveMotionPtr live) {
  const AxisSet axes = live->motion.axes;
  const auto outstanding = [&] { return line_.completions().outstanding() & axes; };
  const auto late_numbers = [&] { return guarded(Guard::late_numbers_wait) && !outstanding().empty(); };
  while (!store_.settled() || late_numbers()) {
    const auto read = co_await reader_.read_positions(Lane::motion, live->context.who);
    if (!read) co_return read;
    int busy = 0;
    for (const int axis : axes.list()) {
      if (busy == 0 && store_.state().axis(axis).busy.value_or(true)) busy = axis;
    }
    if ((busy == 0 || !guarded(Guard::axes_stand_first)) && !late_numbers()) break;
    if (tasks_.now() >= live->context.not_after) co_return tl::unexpected(late(busy, outstanding()));
    auto pause = tasks_.pause(kReadyPoll);
    co_await pause;
    const bool stopped = live->life.stop_asked() && guarded(Guard::stop_before_preparing);
    if (stopped) co_return tl::unexpected(stopped_by(*live));
  }
  co_return Result<void>();
}

Task<Result<void>> Entry::restore_pending(LiveMotionPtr live) {
  if (guarded(Guard::pending_speeds_restored)) {
    co_await restorer_.restore_speeds(live->motion.axes, live->context.who);
  }
  const bool disarmed = co_await restorer_.restore_trigger(live->context.who);
  if (disarmed) co_return Result<void>();
  co_return fail(Reason::device_refused, "the trigger that a scan has left armed could not be taken back",
                 "see that nothing moves, and try again; or switch it off: `ChangeSettings` with `trigger`");
}

Task<Result<void>> Entry::clear_stale_setpoints(LiveMotionPtr live, Register reg) {
  const auto read = co_await reader_.read_registers(live->context.who);
  if (!read) co_return read;
  AxisSet deletable = registers_.clearable() | registers_.set_in(Register::j);
  // A setpoint that another motion has just written on its axes is not stale.
  if (guarded(Guard::others_setpoints_stay)) deletable = deletable & motions_.axes_to_itself(*live);
  if (guarded(Guard::stale_setpoints_deleted) && !deletable.empty()) {
    const auto deleted = co_await delete_setpoints(live, deletable);
    if (!deleted) co_return deleted;
  }
  const AxisSet lasting = lasting_setpoints(*live, reg);
  const bool whole = store_.profile().prebuffer_scope == Scope::controller;
  const bool concerns = whole ? !lasting.empty() : lasting.touches(live->motion.axes);
  if (concerns && guarded(Guard::stale_setpoints_refused)) co_return tl::unexpected(stale_setpoint(lasting));
  co_return Result<void>();
}

namespace {

Problem not_deleted() {
  return {.reason = Reason::stale_setpoint,
          .message =
              "a motion that somebody set and never started is still in the controller, and GC: did not "
              "delete it",
          .hint = "see that all motors are excited and nothing moves, then try again"};
}

}  // namespace

Task<Result<void>> Entry::delete_setpoints(LiveMotionPtr live, AxisSet axes) {
  ExchangeRequest request;
  request.command = commands::clear_setpoints(axes & store_.controllable());
  request.lane = Lane::motion;
  request.caller = live->context.who;
  request.not_after = tasks_.now() + kStepWriteLimit;
  request.motion = live->motion.id;
  auto pending = dialogue_.exchange(std::move(request));
  const auto cleared = co_await pending;
  if (!cleared.accepted()) co_return tl::unexpected(not_deleted());
  registers_.cleared(axes);
  const AxisSet doubtful = (registers_.set_in(Register::j) | registers_.clearable()) & axes;
  if (doubtful.empty()) co_return Result<void>();
  // Manual 87) does not name J: among the deleted setpoints, and does not say what happens to a line or curve if GC:
  // names only some of its axes.
  const auto left = co_await reader_.read_registers(live->context.who);
  if (left && registers_.clearable().touches(axes)) co_return tl::unexpected(not_deleted());
  co_return left;
}

// Returns the axes with setpoints that no command deletes and the motion does not overwrite.
AxisSet Entry::lasting_setpoints(const LiveMotion& live, Register reg) const {
  AxisSet lasting;
  for (const Register kept :
       {Register::j, Register::mp, Register::ap, Register::kp, Register::ep, Register::wt, Register::wi}) {
    const AxisSet set = registers_.set_in(kept);
    const bool overwritten = kept == reg && live.motion.axes.contains(set);
    if (!overwritten) lasting = lasting | set;
  }
  return lasting;
}

}  // namespace axisgate::shrc203
