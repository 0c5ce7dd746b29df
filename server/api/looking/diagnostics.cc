#include "server/api/looking/diagnostics.h"

#include <memory>
#include <optional>
#include <utility>

#include "server/api/looking/support_report.h"
#include "server/api/request/names.h"

namespace axisgate::api {
namespace {

class RecordingReader final : public Subscription<std::string> {
 public:
  RecordingReader(server::Device& device, bool skip_kept, bool follow, Streams::Place place)
      : Subscription(std::move(place)), device_(device), skip_kept_(skip_kept), follow_(follow) {}

 private:
  // The newest line at the start of the call is known only on the device's strand.
  void begin() override {
    woken_by(device_.recorder());
    device_.post([self = self<RecordingReader>()](server::Leases&, TimePoint) { self->begin_here(); });
  }

  void begin_here() {
    server::DeviceRecorder& recorder = device_.recorder();
    server::RecordingRing::Beginning beginning = recorder.begin();
    {
      const std::lock_guard lock(mutex_);
      end_ = beginning.position;
      if (!skip_kept_) beginning = recorder.ring().oldest();
      header_ = std::move(beginning.header);
      reader_.emplace(recorder, beginning.position);
    }
    wake();
  }

  Reading read() override {
    if (!reader_) return Nothing{};
    std::string text = std::exchange(header_, {});
    if (text.empty() && (follow_ || reader_->position().line < end_.line)) text = reader_->next();
    if (!text.empty()) return text;
    if (follow_) return Nothing{};
    return StreamEnd{};
  }

  server::Device& device_;
  const bool skip_kept_, follow_;
  std::optional<server::DeviceRecorder::Reader> reader_;  // nullopt: not begun
  server::RecordingRing::Position end_;                   // end of the recording when the call began
  std::string header_;                                    // sent first
};

}  // namespace

Opened<std::string> Diagnostics::record(const Call& call, std::string_view device, bool skip_kept, bool follow) const {
  const auto admitted = pipeline_.admit({RequestKind::record, call, find_device(gateway_, device)});
  if (!admitted) return tl::unexpected(admitted.error());
  Result<Streams::Place> place = streams_.take(RequestKind::record, admitted->caller.who);
  if (!place) return tl::unexpected(place.error());
  return std::make_shared<RecordingReader>(*admitted->device, skip_kept, follow, *std::move(place));
}

Opened<std::string> Diagnostics::report(const Call& call, const DoorReport& door) const {
  const auto caller = admission_.check_role(RequestKind::get_support_report, call.credential);
  if (!caller) return tl::unexpected(caller.error());
  Result<Streams::Place> place = streams_.take(RequestKind::get_support_report, caller->who);
  if (!place) return tl::unexpected(place.error());
  return std::make_shared<SupportReport>(gateway_, door, *std::move(place));
}

}  // namespace axisgate::api
