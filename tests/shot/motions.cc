// Motions of the controller, from their turn to their outcome.
#include <algorithm>
#include <utility>

#include "tests/shot/controller.h"

namespace axisgate::shot2 {

Controller::LivePtr Controller::find(MotionId id) const {
  const auto found = std::ranges::find_if(live_, [id](const LivePtr& live) { return live->motion.id == id; });
  return found == live_.end() ? nullptr : *found;
}

Task<void> Controller::run(LivePtr live) {
  const MotionId id = live->motion.id;
  while (find(id) && (live_.front() != live || !stops_.empty()) && tasks_.now() < live->context.not_after) {
    auto turn = moved_.wait_until(live->context.not_after);
    co_await turn;
  }
  if (!find(id)) co_return;
  if (live_.front() != live || !stops_.empty()) {
    co_return end(live, MotionState::failed,
                  Problem{.reason = Reason::deadline_passed, .message = "its turn did not come in time"});
  }
  permission_.begin({live->context.who, live->context.lease, live->motion.axes, id}, stage::occupation_by(live->motion),
                    tasks_.now());
  const auto started = co_await start(live);
  if (!find(id)) co_return;
  if (!started) {
    const bool unknown = started.error().reason == Reason::outcome_unknown;
    co_return end(live, unknown ? MotionState::unknown : MotionState::failed, started.error());
  }
  live->motion.started = tasks_.now();
  live->motion.state = live->stopped_by.empty() ? MotionState::running : MotionState::stopping;
  emit(MotionChanged{live->motion});
  if (const auto tell = std::exchange(live->on_started, {})) tell(live->motion);
  co_await watch(live);
}

// Starts nothing before all targets were certainly received. Each start is written once.
Task<Result<void>> Controller::start(const LivePtr& live) {
  const std::vector<AxisSet> sets = by_letter(live->motion.axes);
  for (const AxisSet axes : sets) {
    if (!live->targets) break;
    const auto set = co_await set_targets(live, axes);
    if (!set) co_return set;
  }
  for (const AxisSet axes : sets) {
    const auto started = co_await go(live, axes);
    if (started) continue;
    if (axes != sets.front()) stop_axes(live->motion.axes, "the gateway (a start failed)", [](const StopReport&) {});
    co_return started;
  }
  co_return Result<void>();
}

Task<Result<void>> Controller::set_targets(const LivePtr& live, AxisSet axes) {
  Arguments arguments;
  arguments.axes(axes);
  for (const int axis : axes.list()) arguments.pulses(live->targets->at(axis));
  ExchangeRequest set = request_of(model_.make("AP:", arguments), Lane::motion, live->context.who);
  set.motion = live->motion.id;
  auto written = line_.exchange(std::move(set), tasks_.now());
  const ExchangeResult result = co_await written;
  if (result.accepted()) co_return Result<void>();
  co_return tl::unexpected(
      result.problem.value_or(Problem{.reason = Reason::device_refused, .message = "the target was refused"}));
}

Task<Result<void>> Controller::go(const LivePtr& live, AxisSet axes) {
  ExchangeRequest go = request_of(model_.make(live->targets ? "G:" : "HRT:", axes), Lane::motion, live->context.who);
  go.motion = live->motion.id;
  go.completes = axes;
  auto written = line_.exchange(std::move(go), tasks_.now());
  const ExchangeResult result = co_await written;
  if (result.accepted()) co_return Result<void>();
  if (!result.written) co_return tl::unexpected(*result.problem);
  if (result.refused()) co_return fail(Reason::device_refused, "the start was refused");
  if (result.received == false) co_return fail(Reason::not_sent, "the controller has not received the start");
  co_return fail(Reason::outcome_unknown, "the start was not answered, and is not sent again");
}

Task<void> Controller::watch(const LivePtr& live) {
  const MotionId id = live->motion.id;
  while (find(id)) {
    co_await read(Lane::motion, live->context.who);
    if (!find(id)) co_return;
    const auto is_busy = [this](int axis) { return state_.axis(axis).busy.value_or(true); };
    if (std::ranges::none_of(live->motion.axes.list(), is_busy)) co_return judge(live);
    auto pause = tasks_.pause(profile_.moving_poll);
    co_await pause;
  }
}

void Controller::judge(const LivePtr& live) {
  const auto reached = [this](const AxisResult& one) {
    return state_.axis(one.axis).position_pulses == one.target_pulses;
  };
  if (std::ranges::all_of(live->motion.results, reached)) {
    for (const int axis : live->motion.axes.list()) {
      if (live->targets) continue;
      state_.axis(axis).homed = true;
      ++state_.axis(axis).homings;
    }
    return end(live, MotionState::succeeded, {});
  }
  if (!live->stopped_by.empty()) {
    return end(live, MotionState::stopped,
               Problem{.reason = Reason::stopped, .message = "stopped by " + live->stopped_by});
  }
  end(live, MotionState::failed,
      Problem{.reason = Reason::target_not_reached, .message = "it is stationary, but not at its target"});
}

void Controller::end(const LivePtr& live, MotionState outcome, std::optional<Problem> problem) {
  const bool had_turn = live_.front() == live;
  std::erase(live_, live);
  live->motion.state = outcome;
  live->motion.ended = tasks_.now();
  live->motion.problem = std::move(problem);
  for (AxisResult& one : live->motion.results) one.command_pulses = state_.axis(one.axis).position_pulses;
  ended_.push_back(live->motion);
  if (ended_.size() > kMotionsKept) ended_.pop_front();
  line_.withdraw([id = live->motion.id](const ExchangeRequest& request) { return request.motion == id; },
                 {.reason = Reason::stopped, .message = "the motion has ended"});
  emit(MotionChanged{live->motion});
  if (had_turn) permission_.end(live->motion.id, tasks_.now());
  moved_.notify();
  const auto tell = std::exchange(live->on_started, {});
  if (!tell) return;
  const bool refused = live->motion.problem && outcome != MotionState::unknown;
  tell(refused ? Result<Motion>(tl::unexpected(*live->motion.problem)) : Result<Motion>(live->motion));
}

}  // namespace axisgate::shot2
