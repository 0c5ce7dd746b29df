// Part of PathRun: segments that begin while the axes are stationary, and finding out which segments ran.
#include <fmt/format.h>

#include <algorithm>

#include "device/core/guard.h"
#include "device/shrc203/command/refusals.h"
#include "device/shrc203/limits.h"
#include "device/shrc203/motion/path_run.h"

namespace axisgate::shrc203 {

Task<void> PathRun::start_from_rest(int number) {
  release_line();
  const bool resting = co_await become_stationary();
  if (!resting) co_return;
  change(SegmentEvent::became_stationary);
  tell(PathProgress::Step::done, running_);
  const bool good = co_await wait_before(number);
  if (good) co_await start(number);
}

// Waits until the running segment has ended and its completions have arrived: they must not be taken for the next
// segment's.
Task<bool> PathRun::become_stationary() {
  const bool due = co_await parts_.standstill.wait_until(live_, segment_began_ + segment(running_).shortest);
  if (!due) co_return false;
  for (;;) {
    const bool standing = co_await parts_.standstill.wait(live_);
    if (!standing || live_->life.stop_asked()) co_return false;
    const auto error = error_shown(live_->motion.axes, parts_.store.state());
    if (error) {
      end(MotionState::failed, *error);
      co_return false;
    }
    const bool numbers_in = (parts_.line.completions().outstanding() & plan_.axes).empty();
    if (stands_at_end(running_) && numbers_in) co_return true;
    const TimePoint visible_at = segment_began_ + segment(running_).longest + kSegmentEndVisibleWithin;
    if (numbers_in && parts_.tasks.now() >= visible_at) {
      end(MotionState::failed,
          Problem{.reason = Reason::target_not_reached,
                  .message = fmt::format("the axes are stationary, but not at the end of segment {}", running_),
                  .hint = "check the positions and the controller's front panel"});
      co_return false;
    }
  }
}

// Returns the segment at whose end the axes are; 0 for the beginning of the path. nullopt if no segment, or more than
// one, fits.
std::optional<int> PathRun::last_run() const {
  int done = -1, matches = 0;
  for (int candidate = std::max(0, running_ - 1); candidate <= std::min(running_ + 1, count()); ++candidate) {
    const bool here = candidate == 0 ? parts_.standstill.is_at(plan_.axes, plan_.begin, 0) : stands_at_end(candidate);
    if (!here) continue;
    ++matches;
    done = candidate;
  }
  const bool ambiguous = matches > 1 && guarded(Guard::path_place_is_unique);
  return matches == 0 || ambiguous ? std::nullopt : std::optional(done);
}

// Continues the path with the segment after the last one that ran, as the counters show at READY.
Task<void> PathRun::resume_from_ready() {
  release_line();
  auto pause = parts_.tasks.pause(3 * kReadyPoll);
  co_await pause;
  const bool standing = co_await parts_.standstill.wait(live_);
  if (!standing || live_->life.stop_asked()) co_return;
  if (const auto error = error_shown(live_->motion.axes, parts_.store.state())) {
    end(MotionState::failed, *error);
    co_return;
  }
  const auto done = last_run();
  if (!done) {
    end(MotionState::unknown, Problem{.reason = Reason::outcome_unknown,
                                      .message = "the path stopped at a position that does not show which segments ran",
                                      .hint = "check the positions before the next motion"});
    co_return;
  }
  for (int number = std::max(1, live_->motion.segments_done + 1); number <= *done; ++number) {
    tell(PathProgress::Step::done, number);
  }
  change(SegmentEvent::found);
  running_ = *done;
  missed_ = 0;
  clock_axis_ = 0;
  if (*done == count()) {
    if (live_->scan) co_await parts_.triggers.count(live_);
    parts_.motions.end(*live_, MotionState::succeeded, {});
    co_return;
  }
  const bool good = co_await wait_before(*done + 1);
  if (good) co_await start(*done + 1);
}

}  // namespace axisgate::shrc203
