#include "device/shrc203/motion/scans.h"

#include <utility>

namespace axisgate::shrc203 {

Result<ScanPlan> Scans::plan(const ScanRequest& request, std::optional<Decimal> scale_pulse) const {
  return plan_scan(request, store_.positions(), scale_pulse, store_.envelope(request.context));
}

Result<void> Scans::check(const ScanRequest& request) const {
  const auto planned = plan(request, {});
  return planned ? Result<void>() : tl::unexpected(planned.error());
}

void Scans::scan(ScanRequest request, StageController::OnStarted started) {
  auto good = check(request);
  if (good) good = rights_.authorize_motion(request.context, store_.controllable());
  if (!good) return started(tl::unexpected(good.error()));
  auto live = motions_.create(MotionKind::scan, AxisSet::of(request.axis), request.context, std::move(started));
  live->uses = store_.controllable();  // there is one trigger
  tasks_.spawn(run(live, std::move(request)));
}

Task<void> Scans::run(LiveMotionPtr live, ScanRequest request) {
  const bool entered = co_await entry_.enter(live, {.reg = Register::ap, .prebuffer = true});
  if (!entered) co_return;
  if (!store_.state().trigger) {
    const auto read = co_await reader_.read_trigger(live->context.who);
    if (!read) {
      motions_.refuse(*live, read.error());
      co_return;
    }
  }
  std::optional<Decimal> scale_pulse;
  if (request.by_scale) scale_pulse = co_await triggers_.read_scale_pulse(request.axis, live->context.who);
  auto planned = plan(request, scale_pulse);
  if (!planned) {
    motions_.refuse(*live, planned.error());
    co_return;
  }
  live->motion.scan = planned->due;
  live->scan.emplace(Scan{planned->trigger, *store_.state().trigger, {}});
  co_await follower_.follow(live, std::move(planned->path));
}

}  // namespace axisgate::shrc203
