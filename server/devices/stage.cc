#include "server/devices/stage.h"

#include <algorithm>
#include <map>
#include <utility>

#include "device/core/explain.h"
#include "device/link/clock.h"
#include "server/log.h"

namespace axisgate::server {
namespace {

// Returns a text such as "1 STOPPED, 3 FAILED".
std::string count_by_outcome(const std::vector<stage::Motion>& motions) {
  std::map<stage::MotionState, int> counts;
  for (const stage::Motion& motion : motions) ++counts[motion.state];
  std::string text;
  for (const auto& [state, count] : counts) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, stage::name(state));
  }
  return text;
}

// Adds the settings that every device has.
stage::Profile profile_of(const DeviceConfig& device, const StageConfig& config) {
  stage::Profile profile = config.profile;
  profile.name = device.name;
  profile.baud = device.baud;
  return profile;
}

}  // namespace

Stage::Stage(const DeviceConfig& device, const StageConfig& config, std::unique_ptr<Line> line, LineThread& thread,
             EventBus& bus, Metrics& metrics, const Executor& readers, LeaseTokens& lease_tokens,
             std::unique_ptr<MotionRecord> record, std::unique_ptr<StopRecord> stops, journal::Journal* journal,
             journal::RequestMemory& requests)
    : Device(device.name, recording_header(profile_of(device, config), config.kind->name()), std::move(line), thread,
             metrics, readers, lease_tokens, journal),
      kind_(*config.kind),
      profile_(profile_of(device, config)),
      newest_state_(readers),
      metrics_(*metrics.registry(), profile_.name, kind_.axis_count()),
      record_(std::move(record)),
      stops_(std::move(stops)),
      entries_(profile_.name, journal, requests),
      events_(profile_.name, bus, metrics_, recorder(), newest_state_, [this](DeviceEvents::Due due) { on_due(due); },
              {record_.get(), stops_.get(), &entries_}),
      controller_(kind_.make_controller(profile_, config.kind_settings, runner(), events_, leases())) {
  inherit();
  if (journal != nullptr) number_motions_after(*journal);
  runner().attach(*controller_, [this] { publish_due(); });
}

void Stage::inherit() {
  stage::Inheritance left = stops_ ? stops_->before() : stage::Inheritance{};
  if (record_) left.unfinished = record_->unfinished();
  controller_->inherit(stage::within(stage::AxisSet::in(whole()), std::move(left)), monotonic_now());
}

void Stage::number_motions_after(const journal::Journal& journal) {
  const stage::MotionId on_record = record_ ? record_->last_motion() : 0;
  const Result<stage::MotionId> last = journal.last_motion(profile_.name);
  if (!last) log::warn("{}: motions may be numbered from 1 again: {}", profile_.name, explain(last.error()));
  controller_->number_motions_after(std::max(last.value_or(0), on_record));
}

std::optional<StartedMotions> Stage::started_before() const {
  return record_ ? record_->started_before() : std::nullopt;
}

void Stage::post(Request request, std::function<void()> too_late) {
  runner().post([this, request = std::move(request)](TimePoint now) { request(*controller_, now); },
                std::move(too_late));
}

void Stage::wind_down(std::function<void()> done) {
  post([this, done = std::move(done)](stage::StageController& controller, TimePoint now) {
    controller.wind_down(now, [this, done](const stage::WindDownReport& report) {
      on_wound_down(report);
      done();
    });
  });
}

Duration Stage::wind_down_limit() const {
  using stage::StageController;
  const bool finishes = profile_.at_exit == stage::AtExit::finish;
  return StageController::kStopLimit + (finishes ? StageController::kFinishLimit : Duration::zero());
}

// Closes the line from within the answer, so that no request comes in between.
void Stage::on_wound_down(const stage::WindDownReport& report) {
  on_due(DeviceEvents::Due::state_at_once);
  shutdown();
  if (report.problem) log::warn("{}: {}", name(), explain(*report.problem));
  log::info("{}: the line is closed; motions that were running: {}", name(),
            report.motions.empty() ? "none" : count_by_outcome(report.motions));
}

// An event must not call back into the controller, and many events come at once. Publishing therefore happens once,
// after the call that caused them. With state_at_once it happens before that call's answer, because the caller may read
// the state.
void Stage::on_due(DeviceEvents::Due due) {
  due_ = true;
  state_due_ = state_due_ || due != DeviceEvents::Due::queues;
  const bool made = controller_ != nullptr;  // null while the controller is being constructed
  if (due == DeviceEvents::Due::state_at_once && made) publish_due();
}

void Stage::publish_due() {
  if (!std::exchange(due_, false)) return;
  for (std::size_t lane = 0; lane < kLaneCount; ++lane) {
    metrics_.set_queued(static_cast<Lane>(lane), controller_->queued(static_cast<Lane>(lane)));
  }
  metrics_.set_outstanding_answers(controller_->outstanding_answers());
  if (!std::exchange(state_due_, false)) return;
  const stage::State& state = controller_->state();
  metrics_.set_state(state);
  newest_state_.publish(state);
}

}  // namespace axisgate::server
