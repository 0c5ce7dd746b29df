// The end: what waits is withdrawn, what runs is stopped or waited for, and what is on the wire is answered.
#include <algorithm>

#include "device/shrc203/controller_impl.h"
#include "device/shrc203/limits.h"

namespace axisgate::shrc203 {
namespace {

constexpr std::int64_t kBitsOfAStop = 20 * 10;  // and of the probe after it

}  // namespace

Task<void> Controller::Impl::wind_down(OnWoundDown done) {
  ending_ = Problem{.reason = Reason::not_sent,
                    .message = "the gateway is ending and sends nothing but stops any more",
                    .hint = "try again when it runs again"};
  std::vector<MotionId> unfinished;
  for (const auto& [id, live] : live_) unfinished.push_back(id);
  auto report = std::make_shared<WindDownReport>();
  gate_.withdraw([](MotionId) { return true; }, *ending_);
  if (profile_.at_exit == AtExit::finish) {
    stop_at_the_end(false, report);
    for (const auto& [id, live] : live_) end_jog(live, ending_);  // it never ends by itself
    co_await wait_for_rest(now_ + kFinishLimit);
  }
  stop_at_the_end(true, report);
  co_await wait_for_rest(now_ + kStopLimit);
  while (!live_.empty()) {
    end_motion(live_.begin()->second, MotionState::unknown,
               Problem{.reason = Reason::outcome_unknown,
                       .message = "the gateway ended before it could see what became of the motion",
                       .hint = "look at the stage; use the wired emergency stop if it moves"});
  }
  co_await restore_all_settings();
  line_.seal(*ending_);
  while (line_.exchanging()) {
    auto pause = tick_.wait_until(now_ + kEndPoll);
    co_await pause;
  }
  if (report->problem) {
    auto pause = tick_.wait_until(now_ + kEndTransmitTime + std::chrono::seconds(kBitsOfAStop) / profile_.baud);
    co_await pause;
  }
  for (const Motion& motion : ended_) {
    if (std::ranges::find(unfinished, motion.id) != unfinished.end()) report->motions.push_back(motion);
  }
  done(*report);
}

// A motion whose start has not been written never starts; it may have set something, which the stop clears or finds.
void Controller::Impl::stop_at_the_end(bool running_too, std::shared_ptr<WindDownReport> report) {
  AxisSet axes;
  for (const auto& [id, live] : live_) {
    const bool runs = live->motion.state != MotionState::queued || line_.starting() == id;
    if (live->inside_gate && (running_too || !runs)) axes = axes | live->motion.axes;
  }
  if (running_too && state_.moving_unknown) axes = AxisSet::all();
  if (axes.empty()) return;
  const RequestContext context{"the gateway, which is ending", "", now_ + kStopLimit};
  stop(axes, false, context, [report](const StopReport& stopped) {
    if (stopped.problem) report->problem = stopped.problem;
  });
}

// Until every motion has its outcome, every stop its answer, and every speed changed for a motion its old value.
Task<void> Controller::Impl::wait_for_rest(TimePoint limit) {
  while (now_ < limit && !(live_.empty() && stops_.empty() && !gate_.others_inside(0))) {
    auto pause = tick_.wait_until(std::min(limit, now_ + kEndPoll));
    co_await pause;
  }
}

}  // namespace axisgate::shrc203
