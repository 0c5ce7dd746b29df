#include "server/rpc/record_stream.h"

#include <utility>

namespace axisgate::rpc {

RecordStream* RecordStream::start(server::Device& device, const api::RecordRequest& request, StreamLimit::Place place) {
  std::shared_ptr<RecordStream> stream(new RecordStream(device.recorder(), request.follow(), std::move(place)));
  stream->open();
  // The subscription ends in closed(), before the stream does.
  stream->subscription_ = device.recorder().subscribe([raw = stream.get()] { raw->pump(); });
  device.post(
      [stream, skip_kept = request.skip_kept()](stage::StageController&, TimePoint) { stream->begin(skip_kept); });
  return stream.get();
}

void RecordStream::begin(bool skip_kept) {
  server::RecordingRing::Beginning beginning = recorder_.begin();
  {
    const std::lock_guard lock(mutex_);
    end_ = beginning.position;
    if (!skip_kept) beginning = recorder_.ring().oldest();
    header_ = std::move(beginning.header);
    reader_.emplace(recorder_, beginning.position);
  }
  pump();
}

RecordStream::Next RecordStream::next() {
  if (!reader_) return Wait{};
  api::RecordResponse response;
  response.set_text(std::exchange(header_, {}));
  if (response.text().empty() && (follow_ || reader_->position().line < end_.line)) response.set_text(reader_->next());
  if (!response.text().empty()) return response;
  return follow_ ? Next(Wait{}) : Next(grpc::Status::OK);
}

}  // namespace axisgate::rpc
