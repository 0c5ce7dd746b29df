// Motions from their record to their outcome.
#include <fmt/format.h>

#include <algorithm>

#include "device/core/guard.h"
#include "device/shrc203/command/refusals.h"
#include "device/shrc203/controller_impl.h"
#include "device/shrc203/limits.h"

namespace axisgate::shrc203 {
namespace {

// Of axes that stand where nobody wanted them, without an error.
Problem fell_short_by(const LiveMotion& live, const State& state) {
  auto off = live.needs_excitation ? start_refused_by(live.motion.axes, state) : std::nullopt;
  if (off && off->reason == Reason::not_excited) {
    off->message = "it came to a stop on the way: " + off->message;
    return *off;
  }
  return {.reason = Reason::target_not_reached,
          .message = live.jog ? "the axes stand, although nobody here has stopped them"
                              : "the axes stand, but not at their targets",
          .hint = "look at the positions and the controller's front panel"};
}

}  // namespace

LiveMotionPtr Controller::Impl::create_motion(MotionKind kind, AxisSet axes, RequestContext context,
                                              OnStarted started) {
  Motion motion;
  motion.id = ++last_motion_;
  motion.kind = kind;
  motion.axes = axes;
  for (const int axis : axes.list()) motion.results.push_back({axis, {}, {}, false});
  motion.who = context.who;
  motion.request_id = context.request_id;
  motion.created = now_;
  context.not_after = default_limit(context.not_after, kMotionStartLimit);
  auto live = std::make_shared<LiveMotion>(executor_, std::move(motion), std::move(context));
  live->uses = axes;
  live->on_started = std::move(started);
  live_[live->motion.id] = live;
  emit(MotionChanged{live->motion});
  return live;
}

void Controller::Impl::set_state(LiveMotion& live, MotionState state) {
  live.motion.state = state;
  emit(MotionChanged{live.motion});
}

void Controller::Impl::mark_running(LiveMotionPtr live) {
  if (live->motion.state != MotionState::queued) return;
  live->motion.started = now_;
  settled_ = false;
  set_state(*live, live->stop_requested ? MotionState::stopping : MotionState::running);
  wake_poll_.notify();
  if (live->jog) live->jog->news.notify();
  if (auto started = std::exchange(live->on_started, {})) started(live->motion);
}

void Controller::Impl::end_motion(LiveMotionPtr live, MotionState outcome, std::optional<Problem> problem) {
  if (is_outcome(live->motion.state)) return;
  const bool never_started = live->motion.state == MotionState::queued;
  if (outcome == MotionState::succeeded && live->on_success) live->on_success();
  live->motion.ended = now_;
  live->motion.problem = std::move(problem);
  if (outcome == MotionState::succeeded || outcome == MotionState::stopped) {
    for (const int axis : live->motion.axes.list()) state_.axis(axis).armed = false;
  }
  for (auto& result : live->motion.results) result.command_pulses = state_.axis(result.axis).position_pulses;
  settled_ = outcome == MotionState::succeeded;
  if (!settled_ && live->wrote && guarded(Guard::registers_unknown_after_failure)) registers_.forget();
  set_state(*live, outcome);
  if (auto started = std::exchange(live->on_started, {})) {
    if (never_started && live->motion.problem && outcome != MotionState::unknown) {
      started(tl::unexpected(*live->motion.problem));
    } else {
      started(live->motion);
    }
  }
  live_.erase(live->motion.id);
  ended_.push_back(live->motion);
  while (ended_.size() > kMotionsKept) ended_.pop_front();
  if (!live->keeps_gate) leave_gate(*live);
}

void Controller::Impl::leave_gate(LiveMotion& live) {
  if (!std::exchange(live.inside_gate, false)) return;
  gate_.leave(live.motion.id);
  permission_.end(live.motion.id, now_);
}

Task<Result<void>> Controller::Impl::enter_gate(LiveMotionPtr live, bool prebuffer) {
  const bool alone = prebuffer && guarded(Guard::path_owns_prebuffers) && profile_.prebuffer_scope == Scope::controller;
  auto entry =
      gate_.enter(live->motion.id, alone ? AxisSet::all() : live->uses, live->context.who, live->context.not_after);
  const auto entered = co_await entry;
  if (!entered) co_return entered;
  live->inside_gate = true;
  const Use use{live->context.who, live->context.lease, live->uses, live->motion.id};
  const auto allowed = permission_.may_use(use, now_);
  if (!allowed && guarded(Guard::lease_asked_at_turn)) co_return allowed;
  const auto meant = check_epochs(live->context);
  permission_.begin(use, now_);
  if (!meant) co_return meant;
  if (live->stop_requested && guarded(Guard::stop_before_preparing)) {
    co_return fail(Reason::stopped, "a stop by " + live->stopped_by + " came before the motion was sent");
  }
  co_return Result<void>();
}

// Before anything is set: the axes stand, no late axis number can come, nothing is left over in the registers, and the
// speeds are known.
Task<Result<void>> Controller::Impl::prepare(LiveMotionPtr live, Register reg) {
  if (state_.link != LinkState::up && state_.link != LinkState::doubtful) {
    co_return tl::unexpected(not_up());
  }
  const AxisSet axes = live->motion.axes;
  // Divisions may have been changed while the motion waited.
  for (const int axis : axes.list()) {
    const auto good = envelope(live->context).check_stage(axis);
    if (!good) co_return good;
  }
  const auto late_numbers = [&] {
    return guarded(Guard::late_numbers_wait) && !(line_.completions().outstanding() & axes).empty();
  };
  while (!settled_ || late_numbers()) {
    const auto read = co_await read_positions(Lane::motion, live->context.who);
    if (!read) co_return read;
    int busy = 0;
    for (const int axis : axes.list()) {
      if (busy == 0 && state_.axis(axis).busy.value_or(true)) busy = axis;
    }
    if ((busy == 0 || !guarded(Guard::axes_stand_first)) && !late_numbers()) break;
    if (now_ >= live->context.not_after) {
      const int late = busy != 0 ? busy : axes.list().front();
      co_return fail_on(late, Reason::axis_busy, fmt::format("axis {} did not come to rest in the time allowed", late),
                        "wait until it stands, or stop it: axisctl stop");
    }
    auto pause = tick_.wait_until(now_ + kReadyPoll);
    co_await pause;
    const bool stopped = live->stop_requested && guarded(Guard::stop_before_preparing);
    if (stopped) co_return fail(Reason::stopped, "stopped by " + live->stopped_by);
  }
  if (guarded(Guard::pending_speeds_restored)) co_await restore_pending_speeds(axes, live->context.who);
  const bool disarmed = co_await restore_pending_trigger(live->context.who);
  if (!disarmed) {
    co_return fail(Reason::device_refused, "the trigger that a scan has left armed could not be taken back",
                   "see that nothing moves, and try again; or set it: axisctl trigger off");
  }
  if (!registers_.known() || registers_.any()) {
    const auto cleared = co_await clear_left_overs(live, reg);
    if (!cleared) co_return cleared;
  }
  const auto problem = error_shown(live->motion.axes, state_);
  if (problem) co_return tl::unexpected(*problem);
  auto ready = co_await check_excitation(live->needs_excitation ? axes : AxisSet(), live->context.who);
  if (ready) ready = co_await learn_speeds(axes, live->context.who);
  if (!ready) co_return ready;
  const bool stopped = live->stop_requested && guarded(Guard::stop_before_preparing);
  if (stopped) co_return fail(Reason::stopped, "stopped by " + live->stopped_by);
  co_return Result<void>();
}

// `reg` is about to be written on all the motion's axes: what it holds there is overwritten (manual 2. 2)).
Task<Result<void>> Controller::Impl::clear_left_overs(LiveMotionPtr live, Register reg) {
  const auto read = co_await read_registers(live->context.who);
  if (!read) co_return read;
  const AxisSet deletable = registers_.clearable() | registers_.set_in(Register::j);
  if (guarded(Guard::left_overs_deleted) && !deletable.empty()) {
    ExchangeRequest request;
    request.command = commands::clear_setpoints(deletable & state_.controllable());
    request.lane = Lane::motion;
    request.caller = live->context.who;
    request.not_after = now_ + kStepWriteLimit;
    request.motion = live->motion.id;
    auto pending = line_.exchange(std::move(request), now_);
    const auto cleared = co_await pending;
    if (!cleared.accepted()) {
      co_return fail(Reason::left_over_setting,
                     "a motion that somebody set and never started is still in the controller, and GC: did not "
                     "delete it",
                     "see that all motors are excited and nothing moves, then try again");
    }
    registers_.cleared(AxisSet::all());
    if (!registers_.set_in(Register::j).empty()) {
      // 87) does not name J: among what it deletes.
      const auto left = co_await read_registers(live->context.who);
      if (!left) co_return left;
    }
  }
  AxisSet lasting;
  for (const Register kept :
       {Register::j, Register::mp, Register::ap, Register::kp, Register::ep, Register::wt, Register::wi}) {
    const AxisSet set = registers_.set_in(kept);
    const bool overwritten = kept == reg && live->motion.axes.contains(set);
    if (!overwritten) lasting = lasting | set;
  }
  const bool concerns =
      profile_.prebuffer_scope == Scope::controller ? !lasting.empty() : lasting.touches(live->motion.axes);
  if (concerns && guarded(Guard::left_overs_refused)) {
    co_return tl::unexpected(left_over(lasting));
  }
  co_return Result<void>();
}

bool Controller::Impl::at_targets(const LiveMotion& live) const {
  return !guarded(Guard::success_at_target) || std::ranges::all_of(live.motion.results, [&](const AxisResult& result) {
    const auto position = state_.axis(result.axis).position_pulses;
    return result.target_pulses && position && std::abs(*position - *result.target_pulses) <= live.slack;
  });
}

bool Controller::Impl::anything_moves() const {
  const bool ours = std::ranges::any_of(live_, [](const auto& entry) {
    return entry.second->motion.state == MotionState::running || entry.second->motion.state == MotionState::stopping;
  });
  return ours || std::ranges::any_of(state_.axes, [](const AxisState& axis) { return axis.busy.value_or(false); });
}

// Waits until every axis number has come, or something else happened to the motion, at most until `limit`.
Task<void> Controller::Impl::wait_for_end(LiveMotionPtr live, TimePoint limit) {
  while (now_ < limit && !live->line_lost && !live->woken) {
    auto news = live->news.wait_until(limit);
    co_await news;
  }
  live->woken = false;
}

// A completion wakes the check; READY, no error and the exact target make the success.
Task<void> Controller::Impl::watch(LiveMotionPtr live, bool start_in_doubt) {
  live->watched = true;
  EndCheck check{.begun = now_, .start_in_doubt = start_in_doubt};
  Duration pause = profile_.moving_poll;
  int failures = 0;
  while (!is_outcome(live->motion.state)) {
    const bool hinted = live->woken;
    co_await wait_for_end(live, now_ + pause);
    if (live->line_lost) {
      end_motion(live, MotionState::unknown,
                 Problem{.reason = Reason::outcome_unknown,
                         .message = "the line was lost while the motion was under way: " + live->line_problem,
                         .hint = "look at the positions before moving on"});
      co_return;
    }
    const bool completed = live->completed == live->motion.axes;
    const auto read = co_await read_positions(completed ? Lane::motion : Lane::poll, live->context.who);
    if (live->line_lost) continue;
    if (read && live->scan && !state_.axis(live->motion.axes.lowest()).busy.value_or(true)) {
      co_await count_triggers(live, false);
    }
    const bool ended_here = live->stop_requested || (live->jog && live->jog->ended);
    const bool fell_short = read && check.ready && !ended_here && !at_targets(*live);
    if (fell_short && live->needs_excitation) {
      (void)co_await read_excitation(live->context.who);  // a motor that was switched off
      if (live->line_lost) continue;
    }
    if (read) {
      judge(live, check);
      failures = 0;
    } else if (++failures > kMotionReadFailuresMax) {
      failures = 0;
      // A jog that was given up would run on.
      if (live->jog) {
        end_jog(live, read.error());
      } else {
        end_motion(live, MotionState::unknown, read.error());
      }
    }
    // A completion may precede READY by the settling (open question completion_before_settle).
    pause = hinted || completed || check.ready ? std::min(profile_.moving_poll, kReadyPoll) : profile_.moving_poll;
  }
}

// The others' axes may go on moving.
Positions Controller::Impl::places_of(const LiveMotion& live) const {
  Positions places = positions_of(state_);
  for (const int other : (AxisSet::all() - live.motion.axes).list())
    places[static_cast<std::size_t>(other - 1)].reset();
  return places;
}

// Decides by the newest reading whether the motion has ended, and how.
void Controller::Impl::judge(LiveMotionPtr live, EndCheck& check) {
  bool busy = false;
  for (const int axis : live->motion.axes.list()) busy = busy || state_.axis(axis).busy.value_or(true);
  const bool stirred = live->completed == live->motion.axes || live->motion.state != MotionState::queued;
  live->seen_busy = live->seen_busy || busy;
  if (busy && (guarded(Guard::success_when_ready) || !at_targets(*live))) {
    check.ready = false;
    mark_running(live);
    return;
  }
  const auto error = error_shown(live->motion.axes, state_);
  // An axis that stands at 0 may have been there before: only an origin return that was seen to run has ended.
  const bool homed = live->motion.kind != MotionKind::home || stirred || !guarded(Guard::home_seen_to_run);
  // A whole circle ends where it began, so it must have been seen to run, or had the time to show.
  const bool ran = live->completed == live->motion.axes || live->seen_busy ||
                   (live->motion.state != MotionState::queued && now_ - check.begun >= kStartVisibleWithin);
  const bool evident = homed && (ran || !live->ends_where_it_began || !guarded(Guard::circle_seen_to_run));
  // One flipped bit makes an R of a B; where no axis number bears a READY out, a second reading does.
  const Positions here = places_of(*live);
  const bool borne_out = !guarded(Guard::success_seen_twice) || live->completed == live->motion.axes ||
                         (check.ready && here == check.positions);
  const bool good = !error || !guarded(Guard::success_without_error);
  if (at_targets(*live) && good && evident && borne_out && !live->cut_short) {
    end_motion(live, MotionState::succeeded, {});
    return;
  }
  const bool agreed = (check.ready && here == check.positions) || !guarded(Guard::end_seen_twice);
  const bool shown = now_ - check.begun >= kStartVisibleWithin || !guarded(Guard::start_shows_late);
  if (!agreed || !shown) {
    check.ready = true;
    check.positions = here;
    return;
  }
  if (check.start_in_doubt && live->motion.state == MotionState::queued && !error) {
    end_motion(
        live, MotionState::unknown,
        Problem{.reason = Reason::outcome_unknown,
                .message = "the answer to the start was lost, and nothing tells whether the motion ran to its end",
                .hint = "look at the positions; the motion was not sent again"});
  } else if (live->jog && live->jog->ended && !error) {
    judge_jog(live);
  } else if (live->stop_requested) {
    end_motion(live, MotionState::stopped,
               Problem{.reason = Reason::stopped, .message = "stopped by " + live->stopped_by});
  } else {
    end_motion(live, MotionState::failed, error ? *error : fell_short_by(*live, state_));
  }
}

}  // namespace axisgate::shrc203
