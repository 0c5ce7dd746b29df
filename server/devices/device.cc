#include "server/devices/device.h"

#include <utility>

namespace axisgate::server {

Device::Device(std::string name, const stage::RecordingHeader& header, std::unique_ptr<Line> line, LineThread& thread,
               Metrics& metrics, const Executor& readers, LeaseTokens& lease_tokens)
    : name_(std::move(name)),
      line_(std::move(line)),
      newest_leases_(readers),
      metrics_(metrics, name_),
      recorder_(header, readers, metrics_),
      leases_(lease_tokens),
      runner_(thread.new_strand(), line_->opener(), &thread.wakefulness()) {
  leases_.on_change = [this](TimePoint now) {
    newest_leases_.publish({leases_.held(), leases_.waiting(now), leases_.held_back()});
  };
}

void Device::start() {
  line_->start();
  runner_.start();
}

void Device::shutdown() {
  runner_.shutdown();
  line_->shutdown();
}

}  // namespace axisgate::server
