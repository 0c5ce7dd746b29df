#include "device/shrc203/motion/jog_watchdog.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "device/core/guard.h"
#include "device/shrc203/limits.h"
#include "device/shrc203/motion/jog_bound.h"

namespace axisgate::shrc203 {
namespace {

constexpr Duration kSilence = StageController::kJogSilence;

}  // namespace

Task<void> JogWatchdog::run(LiveMotionPtr live) {
  Jog& jog = *live->jog;
  while (!live->life.has_outcome()) {
    if (!jog.must_end() && live->life.stop_asked()) {
      // The stop may name only some of the axes, and the others never end by themselves.
      motions_.jog_changed(*live, JogEvent::must_end);
      jog.why = stopped_by(*live);
    }
    if (!jog.must_end()) {
      if (auto why = must_end(*live)) motions_.end_jog(*live, std::move(why));
    }
    if (jog.phase == JogPhase::ending) stop(live);
    const bool runs = live->motion.state == MotionState::running && jog.phase == JogPhase::running;
    // In another task: a missing reply must not keep a stop waiting.
    if (runs && jog.speeds != jog.sent) tasks_.spawn(change_speeds(live));
    auto changed = jog.changed.wait_until(next_look(*live));
    co_await changed;
  }
}

void JogWatchdog::stop(LiveMotionPtr live) {
  const Jog& jog = *live->jog;
  motions_.jog_changed(*live, JogEvent::stop_asked);
  const RequestContext gateway{.who = jog.why ? "the gateway: " + jog.why->message : live->context.who};
  stops_.cancel(live->motion.id, gateway,
                [this, live](const Result<void>&) { motions_.jog_changed(*live, JogEvent::stop_answered); });
}

std::optional<Problem> JogWatchdog::must_end(const LiveMotion& live) {
  if (tasks_.now() - live.jog->renewed >= kSilence && guarded(Guard::jog_needs_renewal)) {
    return Problem{.reason = Reason::stopped,
                   .message = fmt::format("the caller of the jog was silent for {} ms",
                                          std::chrono::duration_cast<std::chrono::milliseconds>(kSilence).count()),
                   .hint = "renew it several times in that time, from a connection that holds"};
  }
  // A jog would never end under a lease that lets motion finish, so the lease itself is checked.
  const Use use{live.context.who, live.context.lease, live.uses, 0};
  if (live.context.lease != 0 && guarded(Guard::jog_ends_with_its_right)) {
    if (const auto allowed = rights_.still_authorized(use); !allowed) return allowed.error();
  }
  return near_bound(live);
}

std::optional<Problem> JogWatchdog::near_bound(const LiveMotion& live) const {
  if (live.jog->begun == TimePoint{}) return {};
  const JogBound bounds(store_, live, tasks_.now());
  for (const int axis : live.motion.axes.list()) {
    const auto at = bounds.stop_at(axis);
    if (!at || *at > tasks_.now() || !guarded(Guard::jog_ends_before_bound)) continue;
    const Envelope limits = store_.envelope(live.context);
    const auto bound = limits.bound(axis, live.jog->directions.at(axis));
    return Problem{.reason = Reason::outside_travel,
                   .message = fmt::format("{} came near its travel limit of {}", limits.label(axis),
                                          bound ? limits.as_text(axis, *bound) : ""),
                   .hint = "move it the remaining displacement, or jog it back",
                   .axis = axis};
  }
  return {};
}

TimePoint JogWatchdog::next_look(const LiveMotion& live) const {
  const TimePoint now = tasks_.now();
  if (live.jog->must_end()) return now + kJogStopRepeat;
  TimePoint next = live.jog->renewed + kSilence;
  // No event reports the end of a lease.
  if (live.context.lease != 0) next = std::min(next, now + kJogLeasePoll);
  if (live.jog->begun != TimePoint{}) {
    const JogBound bounds(store_, live, now);
    for (const int axis : live.motion.axes.list()) {
      if (const auto at = bounds.stop_at(axis)) next = std::min(next, *at);
    }
  }
  return std::max(next, now + std::chrono::milliseconds(1));
}

// Sends the requested speeds. Setting a speed twice does no harm, so an unanswered setting is sent again.
Task<void> JogWatchdog::change_speeds(LiveMotionPtr live) {
  Jog& jog = *live->jog;
  motions_.jog_changed(*live, JogEvent::speed_asked);
  const auto asked = jog.speeds;
  auto wanted = asked;
  const JogBound bounds(store_, *live, tasks_.now());
  for (auto& [axis, speed] : wanted) {
    speed = bounds.speed_that_fits(axis);
    jog.fastest[axis] = std::max(jog.fastest[axis], speed);
  }
  jog.changed.notify();  // the stop must come earlier at a higher speed
  for (int attempt = 0; attempt < kJogSpeedTries && !live->life.stop_asked() && !jog.must_end(); ++attempt) {
    auto request = dialogue_.request_of(*live, commands::set_jog_speeds(wanted), Lane::motion);
    request.not_after = tasks_.now() + kJogSpeedWriteLimit;
    auto pending = dialogue_.exchange(std::move(request));
    const auto result = co_await pending;
    if (result.accepted()) {
      for (const auto& [axis, speed] : wanted) jog.fastest[axis] = speed;
    }
    if (!result.in_doubt()) break;
  }
  // Also after a refusal: the speed is not sent again, and the caller's next request is tried.
  jog.sent = asked;
  motions_.jog_changed(*live, JogEvent::speed_answered);
  jog.changed.notify();
}

}  // namespace axisgate::shrc203
