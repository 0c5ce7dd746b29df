#include "server/devices/device.h"

#include <spdlog/spdlog.h>

#include <map>
#include <utility>

#include "server/explain.h"

namespace axisgate::server {
namespace {

// "1 STOPPED, 3 FAILED", by outcome.
std::string count_by_outcome(const std::vector<stage::Motion>& motions) {
  std::map<stage::MotionState, int> counts;
  for (const stage::Motion& motion : motions) ++counts[motion.state];
  std::string text;
  for (const auto& [state, count] : counts) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, stage::name(state));
  }
  return text;
}

}  // namespace

Device::Device(const DeviceConfig& config, std::unique_ptr<Line> line, Strand strand, EventBus& bus, Metrics& metrics,
               const Executor& readers, LeaseTokens& lease_tokens)
    : kind_(*config.kind),
      profile_(config.profile),
      line_(std::move(line)),
      newest_state_(readers),
      newest_leases_(readers),
      metrics_(metrics, profile_.name),
      recorder_(recording_header(profile_), readers, metrics_),
      events_(profile_.name, bus, metrics_, recorder_, [this](DeviceEvents::Due due) { on_due(due); }),
      leases_(lease_tokens),
      runner_(std::move(strand), line_->opener()),
      controller_(kind_.make_controller(profile_, config.kind_settings, runner_, events_, leases_)) {
  leases_.on_change = [this](TimePoint now) {
    newest_leases_.publish({leases_.held(), leases_.waiting(now), leases_.held_back()});
  };
  runner_.attach(*controller_);
}

void Device::post(Request request) {
  runner_.post([this, request = std::move(request)](TimePoint now) { request(*controller_, now); });
}

void Device::start() {
  line_->start();
  runner_.start();
}

void Device::wind_down(std::function<void()> done) {
  post([this, done = std::move(done)](stage::StageController& controller, TimePoint now) {
    controller.wind_down(now, [this, done](const stage::WindDownReport& report) {
      on_wound_down(report);
      done();
    });
  });
}

// Closed from within the answer, so that nothing comes in between.
void Device::on_wound_down(const stage::WindDownReport& report) {
  state_due_ = true;
  publish_due();
  shutdown();
  if (report.problem) spdlog::warn("{}: {}", name(), explain(*report.problem));
  spdlog::info("{}: the line is closed; motions that were running: {}", name(),
               report.motions.empty() ? "none" : count_by_outcome(report.motions));
}

void Device::shutdown() {
  runner_.shutdown();
  line_->shutdown();
}

// An event must not call back into the controller, and many come at once: what they leave to do is done once, later.
void Device::on_due(DeviceEvents::Due due) {
  state_due_ = state_due_ || due == DeviceEvents::Due::state;
  if (publishing_) return;
  publishing_ = true;
  runner_.post([this](TimePoint) { publish_due(); });
}

void Device::publish_due() {
  publishing_ = false;
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
