// Jogs: axes that run until they are stopped (manual 88) J:, 93) JD:), and the one who keeps an eye on them. The
// controller would run them to their limit sensors whatever becomes of the caller, so the gateway stops them.
#include <fmt/format.h>

#include <algorithm>

#include "device/core/guard.h"
#include "device/shrc203/controller_impl.h"
#include "device/shrc203/limits.h"

namespace axisgate::shrc203 {
namespace {

using JogAxes = std::vector<JogRequest::Axis>;

// Between a position's being true and the stop that follows from it there may be one whole time limit of a reply, and
// some lines: that of the position, the one ahead, ?:CMD before a stop behind a silence, and the stop itself.
constexpr int kLines = 4;
constexpr int kLineBits = 64 * 10;

double seconds(Duration duration) { return std::chrono::duration<double>(duration).count(); }

// How far an axis goes on from `speed` until it stands: down to S by (F - S) / R (manual 89)).
double slowing_way(std::int64_t speed, const AxisState& axis) {
  const auto from = static_cast<double>(speed), minimum = static_cast<double>(axis.minimum_speed.value_or(1));
  const double ramp = static_cast<double>(axis.acceleration_ms.value_or(1000)) / 1000;
  const double slope = (static_cast<double>(axis.maximum_speed.value_or(1)) - minimum) / ramp;
  if (from <= minimum) return 0;
  return slope <= 0 ? from * ramp : std::max(from * ramp, (from * from - minimum * minimum) / (2 * slope));
}

std::int64_t start_speed(const AxisState& axis, const std::optional<std::int64_t>& cap) {
  const std::int64_t own = axis.minimum_speed.value_or(1);
  return cap ? std::min(own, *cap) : own;
}

tl::unexpected<Problem> near_bound(const Envelope& envelope, int axis, std::int64_t bound) {
  return fail_on(axis, Reason::outside_travel,
                 fmt::format("{} is too near to its travel limit of {} to jog on towards it", envelope.label(axis),
                             envelope.as_text(axis, bound)),
                 "move it there, or jog it more slowly");
}

// Everything but the speeds of the start, which are known in prepare() at the latest.
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

Command jog_setter(const JogKeeping& jog, AxisSet axes) {
  commands::Amounts directions;
  for (const int axis : axes.list()) directions[axis] = jog.directions.at(axis);
  return commands::set_jog(directions);
}

}  // namespace

MotionId Controller::Impl::jog(JogRequest request, OnStarted started) {
  const auto speeds = check_jog(request.axes, envelope(request.context));
  if (!speeds) {
    started(tl::unexpected(speeds.error()));
    return 0;
  }
  const AxisSet axes = axes_of(request.axes);
  if (const auto allowed = may_use(request.context, axes); !allowed) {
    started(tl::unexpected(allowed.error()));
    return 0;
  }
  auto live = create_motion(MotionKind::jog, axes, request.context, std::move(started));
  live->jog.emplace(executor_);
  live->jog->renewed = now_;
  live->jog->epoch = state_.device_epoch;
  live->jog->speeds = *speeds;
  for (const auto& one : request.axes) live->jog->directions[one.axis] = one.direction;
  executor_.spawn(run_jog(live, std::move(request)));
  executor_.spawn(keep_jog(live));
  return live->motion.id;
}

Result<void> Controller::Impl::renew_jog(MotionId id, const JogAxes& speeds) {
  const auto found = live_.find(id);
  if (found == live_.end() || !found->second->jog) {
    return fail(Reason::not_found, fmt::format("the jog {} has ended", id), "see its outcome: GetMotion");
  }
  LiveMotion& live = *found->second;
  const Envelope limits = envelope(live.context);
  for (const auto& [axis, direction, speed] : speeds) {
    if (!live.motion.axes.has(axis) || !speed) {
      return fail(Reason::unknown_axis, fmt::format("axis {} is none of this jog's, or has no speed", axis),
                  "name axes of the jog, each with its new speed");
    }
    const auto asked = limits.speed(axis, *speed);
    if (!asked) return tl::unexpected(asked.error());
    live.jog->speeds[axis] = *asked;
  }
  live.jog->renewed = now_;
  live.jog->news.notify();
  return {};
}

void Controller::Impl::end_jog(LiveMotionPtr live, std::optional<Problem> why) {
  if (!live->jog || live->jog->ended || live->stop_requested) return;
  live->jog->ended = true;
  live->jog->why = std::move(why);
  live->jog->news.notify();
}

Task<void> Controller::Impl::run_jog(LiveMotionPtr live, JogRequest request) {
  auto ready = co_await enter_gate(live, false);
  if (ready) ready = co_await prepare(live, Register::j);
  if (!ready) {
    end_motion(live, ready.error().reason == Reason::stopped ? MotionState::stopped : MotionState::failed,
               ready.error());
    co_return;
  }
  const Speeds before = known_speeds(live->motion.axes);
  const Envelope limits = envelope(live->context);
  auto checked = check_jog(request.axes, limits);
  MovePlan slower;  // for axes whose own S is more than they may run at
  for (const int axis : live->motion.axes.list()) {
    if (!checked) break;
    const auto cap = limits.speed_cap(axis);
    const auto bound = limits.bound(axis, live->jog->directions.at(axis));
    if (!cap || !bound) {
      checked = tl::unexpected(cap ? bound.error() : cap.error());
      break;
    }
    const SpeedSetting& own = before.at(axis);
    const std::int64_t start = start_speed(state_.axis(axis), *cap);
    if (start < own.minimum)
      slower.axes.push_back({axis, 0, {}, SpeedSetting{start, own.maximum, own.acceleration_ms}});
    live->jog->fastest[axis] = start;
    const auto stop_at = stop_before_bound(*live, axis);
    if (!stop_at || *stop_at <= now_) checked = near_bound(limits, axis, *bound);
  }
  if (!checked) {
    end_motion(live, MotionState::failed, checked.error());
    co_return;
  }
  live->keeps_gate = true;  // JD: and D: change speeds
  co_await start_jog(live, std::move(slower));
  live->jog->news.notify();
  if (state_.link != LinkState::down) {
    // JD: has overwritten F, or not (manual 93), note): it is not known before it was read.
    forget_speeds(live->motion.axes);
    const auto read = co_await read_speeds(live->context.who);
    settled_ = settled_ && read.has_value();
  }
  co_await restore_speeds(live, before);
}

// Set, go, watch, as with a move.
Task<void> Controller::Impl::start_jog(LiveMotionPtr live, MovePlan slower) {
  const auto refused = [&](const Problem& problem) {
    end_motion(live, live->stop_requested ? MotionState::stopped : MotionState::failed, problem);
  };
  if (!slower.axes.empty()) {
    const auto lowered = co_await set_speeds(live, slower);
    if (!lowered) co_return refused(lowered.error());
    note_speeds(speeds_of(slower));
  }
  const Command setter = jog_setter(*live->jog, live->motion.axes);
  const auto set = co_await set_and_confirm(live, setter, Lane::motion);
  if (!set) co_return refused(set.error());
  live->jog->begun = now_;
  const auto start = co_await go(live, {});
  if (!start) {
    refused(start.error());
    // The refusal may be another line's: what ran all the same would never end.
    stop(live->motion.axes, false, {.who = "the gateway: a jog that was refused"}, [](const StopReport&) {});
    co_return;
  }
  const bool in_doubt = *start == Start::in_doubt;
  if (in_doubt && co_await start_never_came(live, setter)) {
    co_return refused({.reason = Reason::not_sent,
                       .message = "the start did not reach the controller: nothing moved",
                       .hint = "try again",
                       .sent = std::string(commands::go(live->motion.axes).row->name)});
  }
  live->jog->news.notify();
  co_await watch(live, in_doubt);
}

// Ends the jog when it must, sends new speeds, and stops it again where a stop was not enough.
Task<void> Controller::Impl::keep_jog(LiveMotionPtr live) {
  JogKeeping& jog = *live->jog;
  while (!is_outcome(live->motion.state)) {
    if (!jog.ended && live->stop_requested) {
      // It may have meant some of the axes only, and the others never end by themselves.
      jog.ended = true;
      jog.why = Problem{.reason = Reason::stopped, .message = "stopped by " + live->stopped_by};
    }
    if (!jog.ended) {
      if (auto why = must_end(*live)) end_jog(live, std::move(why));
    }
    if (jog.ended && !jog.stop_pending) {
      jog.stop_pending = true;
      const RequestContext gateway{.who = jog.why ? "the gateway: " + jog.why->message : live->context.who};
      cancel(live->motion.id, gateway, [live](const Result<void>&) { live->jog->stop_pending = false; });
    }
    const bool runs = live->motion.state == MotionState::running && !live->stop_requested && !jog.ended;
    // Beside this task: an answer that does not come must not keep a stop waiting.
    if (runs && jog.speeds != jog.sent && !jog.speed_pending) executor_.spawn(change_jog_speeds(live));
    auto news = jog.news.wait_until(next_look(*live));
    co_await news;
  }
}

std::optional<Problem> Controller::Impl::must_end(const LiveMotion& live) {
  if (now_ - live.jog->renewed >= kJogSilence && guarded(Guard::jog_needs_renewal)) {
    return Problem{.reason = Reason::stopped,
                   .message = fmt::format("the caller of the jog was silent for {} ms",
                                          std::chrono::duration_cast<std::chrono::milliseconds>(kJogSilence).count()),
                   .hint = "renew it several times in that time, from a connection that holds"};
  }
  // Under a lease that lets motion finish it would never end: the lease itself is asked for.
  const Use use{live.context.who, live.context.lease, live.uses, 0};
  if (live.context.lease != 0 && guarded(Guard::jog_ends_with_its_right)) {
    if (const auto allowed = permission_.may_use(use, now_); !allowed) return allowed.error();
  }
  if (!live.jog->begun) return {};
  for (const int axis : live.motion.axes.list()) {
    const auto at = stop_before_bound(live, axis);
    if (!at || *at > now_ || !guarded(Guard::jog_ends_before_bound)) continue;
    const Envelope limits = envelope(live.context);
    const auto bound = limits.bound(axis, live.jog->directions.at(axis));
    return Problem{.reason = Reason::outside_travel,
                   .message = fmt::format("{} came near its travel limit of {}", limits.label(axis),
                                          bound ? limits.as_text(axis, *bound) : ""),
                   .hint = "move it the rest of the way, or jog it back",
                   .axis = axis};
  }
  return {};
}

TimePoint Controller::Impl::next_look(const LiveMotion& live) const {
  if (live.jog->ended) return now_ + kJogStopRepeat;
  TimePoint next = live.jog->renewed + kJogSilence;
  // Nobody tells of a lease's end.
  if (live.context.lease != 0) next = std::min(next, now_ + kJogLeasePoll);
  for (const int axis : live.motion.axes.list()) {
    if (!live.jog->begun) break;
    if (const auto at = stop_before_bound(live, axis)) next = std::min(next, *at);
  }
  return std::max(next, now_ + std::chrono::milliseconds(1));
}

// When at the latest a stop must be asked for, reckoned from the last reading at the highest speed since then; nothing
// where the axis was not read.
std::optional<TimePoint> Controller::Impl::stop_before_bound(const LiveMotion& live, int axis) const {
  return stop_before_bound(live, axis, live.jog->fastest.at(axis));
}

std::optional<TimePoint> Controller::Impl::stop_before_bound(const LiveMotion& live, int axis,
                                                             std::int64_t speed) const {
  const int direction = live.jog->directions.at(axis);
  const auto bound = envelope(live.context).bound(axis, direction);
  const auto& state = state_.axis(axis);
  if (!bound || !state.position_pulses) return {};
  const double left = static_cast<double>(direction * (*bound - *state.position_pulses));
  const double free = (left - slowing_way(speed, state)) / static_cast<double>(speed);
  const Duration reaction =
      profile_.reply_limit + kJogHostDelayMax + kLines * Duration(std::chrono::seconds(kLineBits)) / profile_.baud;
  const double wait = std::min(free - seconds(reaction), 3600.0);
  // Until its start it stood, however old the reading is.
  const TimePoint read = live.jog->begun ? std::max(state_.read, *live.jog->begun) : now_;
  return read + std::chrono::nanoseconds(static_cast<std::int64_t>(wait * 1e9));
}

// It stands, as the gateway or its caller wanted. There is no target to bear that out, so a controller that may have
// restarted is looked at first.
void Controller::Impl::judge_jog(LiveMotionPtr live) {
  const JogKeeping& jog = *live->jog;
  if (line_.state().restart_suspected()) return;
  if (jog.epoch != state_.device_epoch) {
    end_motion(live, MotionState::unknown,
               Problem{.reason = Reason::outcome_unknown,
                       .message = "the controller restarted under the jog",
                       .hint = "home the axes where their places matter"});
  } else {
    end_motion(live, jog.why ? MotionState::stopped : MotionState::succeeded, jog.why);
  }
}

// What was asked for, or what the way to the bound still allows.
std::int64_t Controller::Impl::speed_that_fits(const LiveMotion& live, int axis) const {
  std::int64_t speed = live.jog->speeds.at(axis);
  const std::int64_t present = live.jog->fastest.at(axis);
  while (speed > present) {
    const auto stop_at = stop_before_bound(live, axis, speed);
    if ((stop_at && *stop_at > now_) || !guarded(Guard::jog_ends_before_bound)) return speed;
    speed /= 2;
  }
  return std::min(live.jog->speeds.at(axis), present);
}

// A speed can be set twice without harm, so one that was not answered is sent again.
Task<void> Controller::Impl::change_jog_speeds(LiveMotionPtr live) {
  JogKeeping& jog = *live->jog;
  jog.speed_pending = true;
  const auto asked = jog.speeds;
  auto wanted = asked;
  for (auto& [axis, speed] : wanted) {
    speed = speed_that_fits(*live, axis);
    jog.fastest[axis] = std::max(jog.fastest[axis], speed);
  }
  jog.news.notify();  // the bound is nearer now
  for (int attempt = 0; attempt < kJogSpeedTries && !live->stop_requested && !jog.ended; ++attempt) {
    auto request = motion_request(*live, commands::set_jog_speeds(wanted), Lane::motion);
    request.not_after = now_ + kJogSpeedWriteLimit;
    auto pending = line_.exchange(std::move(request), now_);
    const auto result = co_await pending;
    if (result.accepted()) {
      for (const auto& [axis, speed] : wanted) jog.fastest[axis] = speed;
    }
    if (!result.in_doubt()) break;
  }
  // Also where it was refused: what the caller asks for next is tried anew.
  jog.sent = asked;
  jog.speed_pending = false;
  jog.news.notify();
}

}  // namespace axisgate::shrc203
