#include "device/shrc203/session/wind_down.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "device/shrc203/limits.h"

namespace axisgate::shrc203 {
namespace {

constexpr std::int64_t kBitsOfAStop = 20 * 10;  // of a stop and the probe after it

}  // namespace

Task<void> WindDown::run(StageController::OnWoundDown done) {
  ending_ = Problem{.reason = Reason::not_sent,
                    .message = "the gateway is ending and now sends only stops",
                    .hint = "try again when it runs again"};
  std::vector<MotionId> unfinished;
  for (const auto& [id, live] : motions_.live()) unfinished.push_back(id);
  auto report = std::make_shared<WindDownReport>();
  motions_.gate().withdraw([](MotionId) { return true; }, *ending_);
  if (store_.profile().at_exit == AtExit::finish) {
    stop(Whom::unstarted, report);
    for (const auto& [id, live] : motions_.live()) motions_.end_jog(*live, ending_);  // a jog never ends by itself
    co_await wait_for_rest(tasks_.now() + StageController::kFinishLimit);
  }
  stop(Whom::everybody, report);
  co_await wait_for_rest(tasks_.now() + StageController::kStopLimit);
  while (!motions_.live().empty()) {
    const LiveMotionPtr live = motions_.live().begin()->second;
    motions_.end(*live, MotionState::unknown,
                 Problem{.reason = Reason::outcome_unknown,
                         .message = "the gateway ended before it could see what became of the motion",
                         .hint = "check the stage; use the wired emergency stop if it moves"});
  }
  co_await restorer_.restore_everything();
  co_await finish_line(report->problem.has_value());
  for (const Motion& motion : motions_.ended()) {
    if (std::ranges::find(unfinished, motion.id) != unfinished.end()) report->motions.push_back(motion);
  }
  done(*report);
}

// Waits for the exchange in flight, after which nothing is sent. A last stop that failed has time to leave the driver.
Task<void> WindDown::finish_line(bool stop_failed) {
  line_.seal(*ending_);
  while (line_.exchanging()) {
    auto pause = tasks_.pause(kEndPoll);
    co_await pause;
  }
  if (!stop_failed) co_return;
  auto pause = tasks_.pause(kEndTransmitTime + std::chrono::seconds(kBitsOfAStop) / store_.profile().baud);
  co_await pause;
}

// Stops motions. A motion whose start was not written never starts, but it may have set registers, which the stop
// clears or finds.
void WindDown::stop(Whom whom, Report report) {
  AxisSet axes;
  for (const auto& [id, live] : motions_.live()) {
    const bool runs = !live->life.unstarted() || line_.starting() == id;
    if (live->life.has_turn() && (whom == Whom::everybody || !runs)) axes = axes | live->motion.axes;
  }
  if (whom == Whom::everybody && store_.state().moving_unknown) axes = kAllAxes;
  if (axes.empty()) return;
  const RequestContext context{"the gateway (it is ending)", "", tasks_.now() + StageController::kStopLimit};
  stops_.stop(axes, StopKind::stop, context, [report](const StopReport& stopped) {
    if (stopped.problem) report->problem = stopped.problem;
  });
}

// Waits until every motion has its outcome, every stop its answer, and every speed changed for a motion its old value.
Task<void> WindDown::wait_for_rest(TimePoint limit) {
  while (tasks_.now() < limit && !(motions_.live().empty() && !stops_.pending() && !motions_.gate().others_inside(0))) {
    auto pause = tasks_.until(std::min(limit, tasks_.now() + kEndPoll));
    co_await pause;
  }
}

}  // namespace axisgate::shrc203
