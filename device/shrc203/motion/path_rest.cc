// What a segment waits for while the axes stand: a rest, inputs, a trigger that is armed. The gateway keeps these times
// itself: whether WT: and WI: answer OK or OK_D behind a running segment, and whether their end tells a number, is open
// (manual 57), 58)), and a stop must not have to clear them.
#include <fmt/format.h>

#include <algorithm>

#include "device/core/guard.h"
#include "device/shrc203/command/refusals.h"
#include "device/shrc203/limits.h"
#include "device/shrc203/motion/path_run.h"

namespace axisgate::shrc203 {

Task<bool> PathRun::wait_until(TimePoint limit) {
  while (impl_.now_ < limit && !live_->stop_requested && !live_->line_lost) {
    auto news = live_->news.wait_until(limit);
    co_await news;
  }
  co_return !live_->stop_requested && !live_->line_lost;
}

bool PathRun::stands_at(const std::array<std::int64_t, kAxisCount>& place, std::int64_t slack) const {
  return std::ranges::all_of(plan_.axes.list(), [&](int axis) {
    const auto position = impl_.state_.axis(axis).position_pulses;
    return position && std::abs(*position - place[static_cast<std::size_t>(axis - 1)]) <= slack;
  });
}

// The segment that runs has ended, and its axis numbers are in: they must not be taken for the next one's.
Task<bool> PathRun::come_to_rest() {
  const bool due = co_await wait_until(segment_began_ + segment(running_).shortest);
  if (!due) co_return false;
  for (;;) {
    const bool standing = co_await wait_for_ready();
    if (!standing || live_->stop_requested) co_return false;
    const auto error = error_shown(live_->motion.axes, impl_.state_);
    if (error) {
      give_up(MotionState::failed, *error);
      co_return false;
    }
    const bool numbers_in = (impl_.line_.completions().outstanding() & plan_.axes).empty();
    if (stands_at_end(running_) && numbers_in) co_return true;
    if (numbers_in && impl_.now_ >= segment_began_ + segment(running_).longest + kSegmentEndVisibleWithin) {
      give_up(MotionState::failed,
              Problem{.reason = Reason::target_not_reached,
                      .message = fmt::format("the axes stand, but not at the end of segment {}", running_),
                      .hint = "look at the positions and the controller's front panel"});
      co_return false;
    }
  }
}

Task<void> PathRun::start_from_rest(int number) {
  release_line();
  const bool resting = co_await come_to_rest();
  if (!resting) co_return;
  tell(PathProgress::Step::done, running_);
  const bool good = co_await wait_before(number);
  if (good) co_await start(number);
}

Task<bool> PathRun::wait_before(int number) {
  const SegmentPlan& next = segment(number);
  const bool waits = next.rest > Duration{} || next.inputs;
  if (waits) impl_.mark_running(live_);
  const bool rested = co_await wait_until(impl_.now_ + next.rest);
  if (!rested) co_return false;
  if (next.inputs) {
    show_armed(true);
    const bool shown = co_await wait_for_inputs(*next.inputs);
    show_armed(false);
    if (!shown) co_return false;
  }
  if (waits) {
    const bool there = co_await still_there(number);
    if (!there) co_return false;
  }
  if (next.arm) {
    co_await impl_.count_triggers(live_, true);
    const bool armed = co_await arm(*next.arm);
    if (!armed) co_return false;
  }
  missed_ = 0;
  clock_axis_ = 0;
  live_->completions.clear();
  co_return true;
}

// Somebody at the front panel may have moved the axes meanwhile: the ways that follow would lead elsewhere.
Task<bool> PathRun::still_there(int number) {
  const bool standing = co_await wait_for_ready();
  if (!standing || live_->stop_requested) co_return false;
  const std::int64_t slack = number == 1 ? 0 : segment(number - 1).slack;
  auto problem = error_shown(live_->motion.axes, impl_.state_);
  if (!problem && !stands_at(begin_of(number), slack)) {
    problem = Problem{.reason = Reason::target_not_reached,
                      .message = fmt::format("the axes do not stand where segment {} begins any more", number),
                      .hint = "something else has moved them while they rested: look at the positions"};
  }
  if (!problem) co_return true;
  give_up(MotionState::failed, *problem);
  co_return false;
}

void PathRun::show_armed(bool armed) {
  for (const int axis : plan_.axes.list()) impl_.state_.axis(axis).armed = armed;
  impl_.publish_state();
}

// Two answers in a row: one flipped bit must not start a motion. Nobody's switch starts it once its owner has lost the
// right to the axes, whatever becomes of motions that run.
Task<bool> PathRun::wait_for_inputs(int pattern) {
  int agreed = 0;
  for (;;) {
    const auto told = co_await impl_.ask(commands::Question::inputs, Lane::motion, live_->context.who);
    if (live_->stop_requested || live_->line_lost) co_return false;
    const RequestContext& owner = live_->context;
    const auto allowed = impl_.permission_.may_use({owner.who, owner.lease, live_->uses, 0}, impl_.now_);
    if (owner.lease != 0 && !allowed) {
      give_up(MotionState::stopped, allowed.error());
      co_return false;
    }
    const bool as_wanted = told.reply && !told.problem && parse_integer(told.reply->text) == pattern;
    agreed = as_wanted ? agreed + 1 : 0;
    if (agreed == 2 || (agreed == 1 && !guarded(Guard::inputs_told_twice))) co_return true;
    const bool goes_on = co_await wait_until(impl_.now_ + (as_wanted ? Duration{} : kInputsPoll));
    if (!goes_on) co_return false;
  }
}

// T: sets nothing in motion, and the same twice is the same.
Task<bool> PathRun::arm(Trigger trigger) {
  const Command setter = trigger_command(trigger);
  ExchangeResult result;
  for (int attempt = 0; attempt < kTriggerTries; ++attempt) {
    if (live_->stop_requested || live_->line_lost) co_return false;
    auto pending = impl_.line_.exchange(impl_.motion_request(*live_, setter, Lane::motion), impl_.now_);
    result = co_await pending;
    impl_.note_setting(setter, result);
    if (result.accepted()) co_return true;
    if (result.refused()) break;
  }
  if (result.refused())
    impl_.state_.trigger.reset();  // the NG may have been the line's: it is asked for, to be taken back
  Problem why = result.problem.value_or(Problem{});
  if (result.refused()) why = co_await impl_.explain_refusal(setter, AxisSet::all(), live_->context.who);
  give_up(live_->stop_requested ? MotionState::stopped : MotionState::failed, why);
  co_return false;
}

}  // namespace axisgate::shrc203
