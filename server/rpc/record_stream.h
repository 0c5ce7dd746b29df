// The stream of Record: what is kept of a device's recording, then each new line.
#pragma once

#include <grpcpp/support/server_callback.h>

#include <memory>
#include <optional>
#include <string>

#include "axisgate/v1/diagnostics.pb.h"
#include "server/devices/device.h"
#include "server/rpc/pull_stream.h"
#include "server/rpc/stream_limit.h"

namespace axisgate::rpc {

namespace api = axisgate::v1;

class RecordStream final : public PullStream<grpc::ServerWriteReactor<api::RecordResponse>, api::RecordResponse> {
 public:
  static RecordStream* start(server::Device& device, const api::RecordRequest& request, StreamLimit::Place place);

 private:
  RecordStream(server::DeviceRecorder& recorder, bool follow, StreamLimit::Place place)
      : recorder_(recorder), follow_(follow), place_(std::move(place)) {}

  void begin(bool skip_kept);
  Next next() override;
  void closed() override { subscription_.reset(); }

  server::DeviceRecorder& recorder_;
  const bool follow_;
  const StreamLimit::Place place_;
  // Set on the device's strand, where it is known with which line the call begins.
  std::optional<server::DeviceRecorder::Reader> reader_;
  server::RecordingRing::Position end_;  // of what was kept then
  std::string header_;                   // goes out first
  std::unique_ptr<server::WakeUps::Subscription> subscription_;
};

}  // namespace axisgate::rpc
