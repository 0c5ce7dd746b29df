#include "device/shrc203/session/clear_errors.h"

#include <fmt/format.h>

#include <utility>

#include "device/core/guard.h"
#include "device/shrc203/limits.h"
#include "device/stage/envelope.h"

namespace axisgate::shrc203 {

void ErrorClearing::clear(AxisSet axes, RequestContext context, StageController::OnDone done) {
  tasks_.spawn(run(axes, std::move(context), std::move(done)));
}

// Returns the axes to clear, or the reason why they may not be cleared.
Result<AxisSet> ErrorClearing::check(AxisSet axes, const RequestContext& context) {
  const AxisSet named = axes.empty() ? store_.controllable() : axes;
  if (named.empty()) return tl::unexpected(store_.not_up());
  if (non_host_.away()) return tl::unexpected(non_host_.problem());
  if (open_stops_.including(store_.controllable(), StopKind::emergency) && guarded(Guard::emergency_cleared_for_all)) {
    return fail(Reason::stop_unconfirmed, "the emergency stop is not confirmed: nobody has seen the axes obey it",
                "clear it once it is confirmed; `GetDevice` shows the open stops");
  }
  const auto allowed = lifts_latch(named) ? rights_.check_epochs(context) : rights_.authorize(context, named);
  if (!allowed) return tl::unexpected(allowed.error());
  return named;
}

Task<void> ErrorClearing::run(AxisSet axes, RequestContext context, StageController::OnDone done) {
  const auto named = check(axes, context);
  if (!named) {
    done(tl::unexpected(named.error()));
    co_return;
  }
  ExchangeRequest request;
  request.command = commands::clear_errors(*named);
  request.lease = context.lease;
  if (!lifts_latch(*named)) request.uses = *named;
  request.lane = Lane::motion;
  request.caller = context.who;
  request.identity = context.takes_turns_as();
  request.not_after = context.not_after == TimePoint{} ? tasks_.now() + kCallerWriteLimit : context.not_after;
  auto pending = dialogue_.exchange(std::move(request));
  const auto result = co_await pending;
  store_.unsettle();
  if (result.problem) {
    done(tl::unexpected(*result.problem));
    co_return;
  }
  auto read = co_await reader_.read_excitation(context.who);
  if (read) read = co_await reader_.read_positions(Lane::question, context.who);
  if (!result.accepted()) {
    done(fail(Reason::device_refused, "the controller refused BEC: (NG)", "see `GetDevice`"));
  } else if (!read) {
    done(tl::unexpected(read.error()));
  } else {
    done(lift_latch(*named, context.who));
  }
}

// Reports whether BEC: for these axes lifts the latch. It then needs no right to the axes: nobody can move while the
// latch is set, so the holder of a lease loses nothing.
bool ErrorClearing::lifts_latch(AxisSet axes) const {
  const bool all = axes.contains(store_.controllable()) || !guarded(Guard::emergency_cleared_for_all);
  return store_.state().emergency && all;
}

// Lifts the latch, unless another emergency stop was requested in the meantime.
Result<void> ErrorClearing::lift_latch(AxisSet axes, const std::string& who) {
  if (!lifts_latch(axes) || open_stops_.including(store_.controllable(), StopKind::emergency)) return {};
  for (const int axis : store_.controllable().list()) {
    if (!status_of(store_.state().axis(axis)).emergency()) continue;
    return fail_on(axis, Reason::emergency_stopped,
                   fmt::format("axis {} is still in emergency stop, although BEC: was accepted", axis),
                   "release the emergency stop button, then clear again");
  }
  open_stops_.unlatch(who);
  return {};
}

}  // namespace axisgate::shrc203
