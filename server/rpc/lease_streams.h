// The streams of ControlService: who holds what, and a lease that is kept alive.
#pragma once

#include <grpcpp/support/server_callback.h>

#include <memory>
#include <optional>

#include "axisgate/v1/control.pb.h"
#include "server/gateway.h"
#include "server/rpc/pull_stream.h"
#include "server/rpc/stream_limit.h"

namespace axisgate::rpc {

namespace api = axisgate::v1;

class LeaseWatch final
    : public PullStream<grpc::ServerWriteReactor<api::WatchLeasesResponse>, api::WatchLeasesResponse> {
 public:
  static LeaseWatch* start(server::Device& device, StreamLimit::Place place);

 private:
  LeaseWatch(server::Device& device, StreamLimit::Place place) : device_(device), place_(std::move(place)) {}

  Next next() override;
  void closed() override { subscription_.reset(); }

  server::Device& device_;
  const StreamLimit::Place place_;
  std::optional<std::uint64_t> sent_;  // the version that went out last
  std::unique_ptr<server::WakeUps::Subscription> subscription_;
};

// One message is taken in when the last has been answered.
class LeaseKeeping final
    : public PullStream<grpc::ServerBidiReactor<api::KeepLeaseAliveRequest, api::KeepLeaseAliveResponse>,
                        api::KeepLeaseAliveResponse> {
 public:
  static LeaseKeeping* start(server::Gateway& gateway, Result<StreamLimit::Place> place);

  void OnReadDone(bool ok) override;
  void OnWriteDone(bool ok) override;
  void OnCancel() override;

 private:
  explicit LeaseKeeping(server::Gateway& gateway) : gateway_(gateway) {}

  void keep(server::Device& device, server::LeaseToken token, TimePoint now);
  void end(grpc::Status status);
  Next next() override;

  server::Gateway& gateway_;
  StreamLimit::Place place_;
  api::KeepLeaseAliveRequest incoming_;

  // Under the stream's lock.
  std::optional<api::KeepLeaseAliveResponse> due_;
  std::optional<grpc::Status> end_;
  server::Device* kept_on_ = nullptr;  // null: nothing has been kept alive yet
  server::LeaseToken kept_ = 0;
};

}  // namespace axisgate::rpc
