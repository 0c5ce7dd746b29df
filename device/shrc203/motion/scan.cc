// Scans: the axis is brought to where it sets out, the trigger is armed while it stands (T: is NG while busy, manual
// 98)), it runs, and at READY the trigger is what it was before.
#include <algorithm>
#include <utility>

#include "device/shrc203/controller_impl.h"
#include "device/shrc203/limits.h"
#include "device/shrc203/motion/path_run.h"
#include "device/shrc203/planning/scan_plan.h"

namespace axisgate::shrc203 {

Result<ScanPlan> Controller::Impl::plan_scan(const ScanRequest& request, std::optional<Decimal> scale_pulse) const {
  return shrc203::plan_scan(request, positions_of(state_), scale_pulse, envelope(request.context));
}

void Controller::Impl::scan(ScanRequest request, OnStarted started) {
  if (const auto plan = plan_scan(request, {}); !plan) return started(tl::unexpected(plan.error()));
  if (const auto allowed = may_use(request.context, state_.controllable()); !allowed) {
    return started(tl::unexpected(allowed.error()));
  }
  auto live = create_motion(MotionKind::scan, AxisSet::of(request.axis), request.context, std::move(started));
  live->uses = state_.controllable();  // there is one trigger
  executor_.spawn(run_scan(live, std::move(request)));
}

Task<void> Controller::Impl::run_scan(LiveMotionPtr live, ScanRequest request) {
  auto ready = co_await enter_gate(live, true);
  if (ready) ready = co_await prepare(live, Register::ap);
  if (ready && !state_.trigger) ready = co_await read_trigger(live->context.who);
  if (!ready) {
    end_motion(live, ready.error().reason == Reason::stopped ? MotionState::stopped : MotionState::failed,
               ready.error());
    co_return;
  }
  std::optional<Decimal> scale_pulse;
  if (request.by_scale) scale_pulse = co_await read_scale_pulse(request.axis, live->context.who);
  auto plan = plan_scan(request, scale_pulse);
  if (!plan) {
    end_motion(live, MotionState::failed, plan.error());
    co_return;
  }
  live->motion.scan = plan->due;
  live->scan.emplace(ScanKeeping{plan->trigger, *state_.trigger, {}});
  live->keeps_gate = true;
  co_await follow_path(live, std::move(plan->path));
}

// Nothing where the controller does not tell.
Task<std::optional<Decimal>> Controller::Impl::read_scale_pulse(int axis, std::string caller) {
  const auto told = co_await ask(Question::scale_resolution, Lane::motion, std::move(caller));
  if (!told.reply || told.problem || told.reply->kind != Reply::Kind::data) co_return std::nullopt;
  const auto fields = by_axis(*told.reply, state_.controllable());
  const auto field = fields.find(axis);
  if (field == fields.end()) co_return std::nullopt;
  const auto resolution = parse_decimal(field->second);
  co_return resolution ? std::optional(*resolution) : std::nullopt;
}

// The counter that the trigger counts by, as it is now.
Task<std::optional<std::int64_t>> Controller::Impl::read_counter(int axis, bool of_scale, std::string caller) {
  if (!of_scale) co_return state_.axis(axis).position_pulses;
  const auto result = co_await ask(Question::scale_counters, Lane::motion, std::move(caller));
  if (result.problem || result.reply->kind != Reply::Kind::data) co_return std::nullopt;
  const auto readings = parse_positions(*result.reply, state_.controllable());
  if (!readings) co_return std::nullopt;
  co_return (*readings)[static_cast<std::size_t>(axis - 1)].pulses;
}

// While the axis stands: at the arming, and whenever a reading may be the end.
Task<void> Controller::Impl::count_triggers(LiveMotionPtr live, bool arming) {
  ScanKeeping& keeping = *live->scan;
  if (!arming && !keeping.armed_at) co_return;
  const bool of_scale = keeping.trigger.target != Trigger::Target::drive_pulses;
  const auto counter = co_await read_counter(live->motion.axes.lowest(), of_scale, live->context.who);
  if (arming) {
    keeping.armed_at = counter;
  } else if (counter) {
    live->motion.scan->observed = triggers_on(*counter - *keeping.armed_at, keeping.trigger);
  }
}

// T: is refused while anything moves, which somebody at the front panel may make it do.
Task<void> Controller::Impl::disarm(LiveMotionPtr live) {
  pending_restores_.remember_scan(live->scan->before, live->scan->trigger);
  for (const TimePoint limit = now_ + kTriggerRestoreLimit;
       pending_restores_.has_scan() && now_ < limit && line_works() && !live->line_lost;) {
    const bool restored = co_await restore_pending_trigger(live->context.who);
    if (restored) break;
    auto pause = tick_.wait_until(now_ + kTriggerRestorePause);
    co_await pause;
  }
}

}  // namespace axisgate::shrc203
