// The stream of WatchDevice: the newest state, no more often than asked for.
#pragma once

#include <grpcpp/support/server_callback.h>

#include <memory>
#include <optional>

#include "axisgate/v1/device.pb.h"
#include "server/gateway.h"
#include "server/rpc/pull_stream.h"
#include "server/rpc/stream_limit.h"

namespace axisgate::rpc {

namespace api = axisgate::v1;

class DeviceWatch final
    : public PullStream<grpc::ServerWriteReactor<api::WatchDeviceResponse>, api::WatchDeviceResponse> {
 public:
  static DeviceWatch* start(server::Gateway& gateway, server::Device& device, Duration min_interval,
                            StreamLimit::Place place);

 private:
  DeviceWatch(server::Gateway& gateway, server::Device& device, Duration min_interval, StreamLimit::Place place)
      : gateway_(gateway), device_(device), min_interval_(min_interval), place_(std::move(place)) {}

  Next next() override;
  void closed() override { subscription_.reset(); }

  server::Gateway& gateway_;
  server::Device& device_;
  const Duration min_interval_;
  const StreamLimit::Place place_;
  std::optional<std::uint64_t> sent_;  // the version that went out last
  TimePoint earliest_{};               // for the next message
  bool timer_set_ = false;
  std::unique_ptr<server::WakeUps::Subscription> subscription_;
};

}  // namespace axisgate::rpc
