#include "server/device.h"

#include <utility>

namespace axisgate::server {

Device::Device(shrc203::Profile profile, std::unique_ptr<Line> line, Strand strand, EventBus& bus, Metrics& metrics,
               const Executor& readers)
    : profile_(std::move(profile)),
      line_(std::move(line)),
      newest_state_(readers),
      metrics_(metrics, profile_.name),
      events_(profile_.name, bus, metrics_, [this](DeviceEvents::Due due) { on_due(due); }),
      runner_(std::move(strand), line_->opener()),
      controller_(profile_, runner_, events_) {
  runner_.attach(controller_);
}

void Device::post(Request request) {
  runner_.post([this, request = std::move(request)](TimePoint now) { request(controller_, now); });
}

void Device::start() {
  line_->start();
  runner_.start();
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
    metrics_.set_queued(static_cast<Lane>(lane), controller_.queued(static_cast<Lane>(lane)));
  }
  if (!std::exchange(state_due_, false)) return;
  const shrc203::State& state = controller_.state();
  metrics_.set_state(state);
  newest_state_.publish(state);
}

}  // namespace axisgate::server
