#include "device/shrc203/motion/watch.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "device/core/guard.h"
#include "device/shrc203/command/refusals.h"
#include "device/shrc203/limits.h"

namespace axisgate::shrc203 {
namespace {

// Returns the problem of axes that are stationary away from their targets, without an error or a stop.
Problem fell_short_by(const LiveMotion& live, const State& state) {
  auto off = start_refused_by(live.excited, state);
  if (off && off->reason == Reason::not_excited) {
    off->message = "it stopped before its target: " + off->message;
    return *off;
  }
  return {.reason = Reason::target_not_reached,
          .message = live.jog ? "the axes are stationary, although nobody here has stopped them"
                              : "the axes are stationary, but not at their targets",
          .hint = "check the positions and the controller's front panel"};
}

bool ended_here(const LiveMotion& live) { return live.life.stop_asked() || (live.jog && live.jog->must_end()); }

}  // namespace

bool Watch::watches_any() const {
  return std::ranges::any_of(motions_.live(), [this](const auto& entry) { return watched_.contains(entry.first); });
}

bool Watch::at_targets(const LiveMotion& live) const {
  return !guarded(Guard::success_at_target) || std::ranges::all_of(live.motion.results, [&](const AxisResult& result) {
    const auto position = store_.state().axis(result.axis).position_pulses;
    return result.target_pulses && position && std::abs(*position - *result.target_pulses) <= live.slack;
  });
}

bool Watch::axis_busy(const LiveMotion& live) const {
  return std::ranges::any_of(live.motion.axes.list(),
                             [&](int axis) { return store_.state().axis(axis).busy.value_or(true); });
}

// Waits until all completions have arrived or something else happened to the motion, at most until `limit`.
Task<void> Watch::wait_for_change(LiveMotionPtr live, Seen& seen, TimePoint limit) {
  while (tasks_.now() < limit && !live->life.line_lost() && live->wake_ups == seen.wake_ups) {
    auto changed = live->changed.wait_until(limit);
    co_await changed;
  }
  seen.wake_ups = live->wake_ups;
}

// Waits, once all completions have arrived, for the time after which this unit is usually READY.
Task<void> Watch::wait_for_ready(LiveMotionPtr live, Seen& seen) {
  if (seen.completed_at || !live->completed_by_all()) co_return;
  seen.completed_at = tasks_.now();
  co_await wait_for_change(live, seen, tasks_.now() + ready_lag_.first_question());
}

Task<void> Watch::run(LiveMotionPtr live, Start start, int wake_ups) {
  watched_.insert(live->motion.id);
  Seen seen{.begun = tasks_.now(), .start = start, .wake_ups = wake_ups};
  Duration pause = pause_on_the_way(*live);
  int failures = 0;
  while (!live->life.has_outcome()) {
    const bool hinted = live->wake_ups != seen.wake_ups;
    co_await wait_for_change(live, seen, tasks_.now() + pause);
    co_await wait_for_ready(live, seen);
    if (live->life.line_lost()) {
      motions_.end(*live, MotionState::unknown,
                   Problem{.reason = Reason::outcome_unknown,
                           .message = "the line was lost during the motion: " + live->life.line_problem(),
                           .hint = "check the positions before the next motion"});
      break;
    }
    const TimePoint asked = tasks_.now();
    const auto read = co_await read_end(live, seen);
    if (live->life.line_lost()) continue;
    if (read) {
      learn_lag(*live, seen, asked);
      judge(*live, seen);
      failures = 0;
    } else if (++failures > kMotionReadFailuresMax) {
      unreadable(*live, read.error());
    }
    pause = pause_after(*live, seen, hinted);
  }
  watched_.erase(live->motion.id);
}

// Measures the delay of READY, but not after a stop, whose READY is no measure of settling.
void Watch::learn_lag(const LiveMotion& live, const Seen& seen, TimePoint asked) {
  if (!seen.completed_at || live.life.stop_asked()) return;
  const Duration after = asked - *seen.completed_at;
  if (axis_busy(live)) {
    ready_lag_.seen_busy(after);
  } else {
    ready_lag_.seen_ready(after);
  }
}

Duration Watch::pause_after(const LiveMotion& live, Seen& seen, bool hinted) const {
  const Duration moving_poll = store_.profile().moving_poll, soon = std::min(moving_poll, kReadyPoll);
  if (seen.completed_at && !seen.ready_at) {
    seen.ready_pause = seen.ready_pause == Duration::zero() ? kReadyPauseMin : 2 * seen.ready_pause;
    return std::min(seen.ready_pause, soon);
  }
  return hinted || live.completed_by_all() || seen.ready_at ? soon : pause_on_the_way(live);
}

// Returns the pause between readings during the motion. A completion reports its end, so these readings serve only
// callers who follow the state, and the case of a lost completion.
Duration Watch::pause_on_the_way(const LiveMotion& live) const {
  const Duration moving_poll = store_.profile().moving_poll;
  if (store_.followed() || !live.motion.due || live.life.stop_asked()) return moving_poll;
  const Duration longest = std::max(moving_poll, std::min(kUnfollowedPoll, store_.profile().idle_poll));
  return std::clamp(*live.motion.due + moving_poll - tasks_.now(), moving_poll, longest);
}

// Reads the positions, and other possible reasons why the axes are stationary.
Task<Result<void>> Watch::read_end(LiveMotionPtr live, const Seen& seen) {
  const Lane lane = live->completed_by_all() ? Lane::motion : Lane::poll;
  const auto read = co_await reader_.read_positions(lane, live->context.who);
  if (live->life.line_lost() || !read) co_return read;
  if (live->scan && !store_.state().axis(live->motion.axes.lowest()).busy.value_or(true)) {
    co_await triggers_.count(live);
  }
  const bool fell_short = seen.ready_at && !ended_here(*live) && !at_targets(*live);
  if (fell_short && !live->excited.empty()) {
    (void)co_await reader_.read_excitation(live->context.who);  // a motor may have been switched off
  }
  co_return read;
}

// Handles a motion whose positions cannot be read: it ends UNKNOWN. A jog would continue, so it is stopped.
void Watch::unreadable(LiveMotion& live, const Problem& problem) {
  if (live.jog) {
    motions_.end_jog(live, problem);
  } else {
    motions_.end(live, MotionState::unknown, problem);
  }
}

// Decides by the newest reading whether the motion has ended, and with which outcome.
void Watch::judge(LiveMotion& live, Seen& seen) {
  const bool busy = axis_busy(live);
  seen.busy = seen.busy || busy;
  if (busy && (guarded(Guard::success_when_ready) || !at_targets(live))) {
    seen.ready_at.reset();
    motions_.started(live);
    return;
  }
  const Positions here = places_of(live, store_.state());
  if (has_succeeded(live, seen, here)) {
    motions_.end(live, MotionState::succeeded, {});
    return;
  }
  const bool agreed = seen.ready_at == here || !guarded(Guard::end_seen_twice);
  const bool shown = tasks_.now() - seen.begun >= kStartVisibleWithin || !guarded(Guard::start_shows_late);
  if (!agreed || !shown) {
    seen.ready_at = here;
    return;
  }
  judge_end(live, seen);
}

bool Watch::has_succeeded(const LiveMotion& live, const Seen& seen, const Positions& here) const {
  const bool completed = live.completed_by_all(), started = !live.life.unstarted();
  // An axis at 0 may have been there before the origin return, which therefore must have been seen to run.
  const bool homed = live.motion.kind != MotionKind::home || completed || started || !guarded(Guard::home_seen_to_run);
  // A whole circle ends where it began, so it must have been seen to run, or have had the time to show.
  const bool ran = completed || seen.busy || (started && tasks_.now() - seen.begun >= kStartVisibleWithin);
  const bool evident = homed && (ran || live.goal != Goal::round_trip || !guarded(Guard::circle_seen_to_run));
  // One flipped bit turns a B into an R. A second reading is needed if no completion confirms READY, or if the reading
  // before was READY elsewhere.
  const bool undisputed = completed && !seen.ready_at;
  const bool confirmed = !guarded(Guard::success_seen_twice) || undisputed || seen.ready_at == here;
  const bool good = !error_shown(live.motion.axes, store_.state()) || !guarded(Guard::success_without_error);
  return at_targets(live) && good && evident && confirmed && live.goal != Goal::none;
}

// Ends a motion whose axes are stationary without success.
void Watch::judge_end(LiveMotion& live, const Seen& seen) {
  const auto error = error_shown(live.motion.axes, store_.state());
  if (seen.start == Start::in_doubt && live.life.unstarted() && !error) {
    motions_.end(
        live, MotionState::unknown,
        Problem{.reason = Reason::outcome_unknown,
                .message = "the answer to the start was lost, and nothing shows whether the motion ran to its end",
                .hint = "check the positions; the motion was not sent again"});
  } else if (live.jog && live.jog->must_end() && !error) {
    judge_jog(live);
  } else if (live.life.stop_asked()) {
    motions_.end(live, MotionState::stopped, stopped_by(live));
  } else {
    motions_.end(live, MotionState::failed, error ? *error : fell_short_by(live, store_.state()));
  }
}

// Ends a stationary jog that had to end. No target confirms the position, so a suspected restart of the controller is
// decided first.
void Watch::judge_jog(LiveMotion& live) {
  const Jog& jog = *live.jog;
  if (line_.state().restart_suspected()) return;
  if (jog.epoch != store_.state().device_epoch) {
    motions_.end(live, MotionState::unknown,
                 Problem{.reason = Reason::outcome_unknown,
                         .message = "the controller restarted under the jog",
                         .hint = "home the axes where their positions matter"});
  } else {
    motions_.end(live, jog.why ? MotionState::stopped : MotionState::succeeded, jog.why);
  }
}

}  // namespace axisgate::shrc203
