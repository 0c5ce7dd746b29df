#include "server/devices/device.h"

#include <utility>

#include "server/journal/lease_entries.h"

namespace axisgate::server {

Device::Device(std::string name, const stage::RecordingHeader& header, std::unique_ptr<Line> line, LineThread& thread,
               Metrics& metrics, const Executor& readers, LeaseTokens& lease_tokens, journal::Journal* journal)
    : name_(std::move(name)),
      line_(std::move(line)),
      newest_leases_(readers),
      recorder_(header, readers, metrics.recorder_drops(name_)),
      leases_(lease_tokens),
      runner_(thread.new_strand(), line_->opener(), &thread.wakefulness(), line_->held_reader()) {
  leases_.on_change = [this](TimePoint now) {
    newest_leases_.publish({leases_.held(), leases_.waiting(now), leases_.held_back()});
  };
  if (journal == nullptr) return;
  leases_.on_event = [this, journal](const LeaseEvent& event, TimePoint now) {
    journal->append({journal::entry_of(event, name_, now)});
  };
}

void Device::post(Request request, std::function<void()> too_late) {
  runner_.post([this, request = std::move(request)](TimePoint now) { request(leases_, now); }, std::move(too_late));
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
