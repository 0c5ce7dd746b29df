#include "device/shrc203/motion/segment_halt.h"

#include <fmt/format.h>

#include <utility>

#include "device/core/guard.h"
#include "device/shrc203/command/refusals.h"
#include "device/shrc203/limits.h"
#include "device/shrc203/session/lease_settings.h"

namespace axisgate::shrc203 {

Task<bool> SegmentHalt::wait(LiveMotionPtr live, const SegmentPlan& next, Before before) {
  const bool waits = next.rest > Duration{} || next.inputs;
  if (waits) motions_.started(*live);
  const bool rested = co_await standstill_.wait_until(live, tasks_.now() + next.rest);
  if (!rested) co_return false;
  if (next.inputs) {
    show_armed(*live, true);
    const bool shown = co_await wait_for_inputs(live, *next.inputs);
    show_armed(*live, false);
    if (!shown) co_return false;
  }
  if (waits) {
    const bool there = co_await is_still_there(live, before);
    if (!there) co_return false;
  }
  if (next.arm) {
    co_await triggers_.begin(live);
    const bool armed = co_await arm(live, *next.arm);
    if (!armed) co_return false;
  }
  co_return true;
}

// Checks that the axes have not moved meanwhile: somebody at the front panel may have moved them, and the following
// distances would lead elsewhere.
Task<bool> SegmentHalt::is_still_there(LiveMotionPtr live, Before before) {
  const bool standing = co_await standstill_.wait(live);
  if (!standing || live->life.stop_asked()) co_return false;
  const AxisSet axes = live->motion.axes;
  auto problem = error_shown(axes, store_.state());
  if (!problem && !standstill_.is_at(axes, before.place, before.slack)) {
    problem = Problem{.reason = Reason::target_not_reached,
                      .message = fmt::format("the axes are no longer at the start of segment {}", before.number),
                      .hint = "something else has moved them during the dwell: check the positions"};
  }
  if (!problem) co_return true;
  motions_.end(*live, MotionState::failed, *problem);
  co_return false;
}

void SegmentHalt::show_armed(const LiveMotion& live, bool armed) {
  store_.note_armed(live.motion.axes, armed);
  store_.publish();
}

// Ends the motion if its owner has lost the right to the axes: no input pin may start it then, even if running motions
// may continue.
bool SegmentHalt::has_lost_right(LiveMotion& live) {
  const RequestContext& owner = live.context;
  const auto allowed = rights_.still_authorized({owner.who, owner.lease, live.uses, 0});
  if (owner.lease == 0 || allowed) return false;
  motions_.end(live, MotionState::stopped, allowed.error());
  return true;
}

// Waits until the inputs show the pattern in two replies in a row: one flipped bit must not start a motion.
Task<bool> SegmentHalt::wait_for_inputs(LiveMotionPtr live, int pattern) {
  int agreed = 0;
  for (;;) {
    const auto reported = co_await dialogue_.ask(commands::Question::inputs, Lane::motion, live->context.who);
    if (live->life.stop_asked() || live->life.line_lost()) co_return false;
    if (has_lost_right(*live)) co_return false;
    const bool as_wanted = reported.reply && !reported.problem && parse_integer(reported.reply->text) == pattern;
    agreed = as_wanted ? agreed + 1 : 0;
    if (agreed == 2 || (agreed == 1 && !guarded(Guard::inputs_read_twice))) co_return true;
    const TimePoint again_at = tasks_.now() + (as_wanted ? Duration{} : kInputsPoll);
    const bool continues = co_await standstill_.wait_until(live, again_at);
    if (!continues) co_return false;
  }
}

// Arms the trigger. T: moves nothing and may be repeated without effect.
Task<bool> SegmentHalt::arm(LiveMotionPtr live, Trigger trigger) {
  const Command setter = trigger_command(trigger);
  ExchangeResult result;
  for (int attempt = 0; attempt < kTriggerTries; ++attempt) {
    if (live->life.stop_asked() || live->life.line_lost()) co_return false;
    auto pending = dialogue_.exchange(dialogue_.request_of(*live, setter, Lane::motion));
    result = co_await pending;
    note_setting(store_, setter, result);
    if (result.accepted()) co_return true;
    if (result.refused()) break;
  }
  Problem why = result.problem.value_or(Problem{});
  if (result.refused()) {
    store_.note_trigger({});  // the line may have caused the NG: the trigger is read again before it is restored
    why = co_await explainer_.explain(setter, kAllAxes, live->context.who);
  }
  motions_.disconnect(*live, why);
  co_return false;
}

}  // namespace axisgate::shrc203
