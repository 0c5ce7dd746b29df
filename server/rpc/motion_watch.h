// The stream of WatchMotion: one motion now and at every change, until its outcome.
#pragma once

#include <grpcpp/support/server_callback.h>

#include <memory>
#include <optional>

#include "axisgate/v1/stage.pb.h"
#include "server/gateway.h"
#include "server/rpc/call.h"
#include "server/rpc/fact_reader.h"
#include "server/rpc/pull_stream.h"
#include "server/rpc/stream_limit.h"

namespace axisgate::rpc {

namespace api = axisgate::v1;

class MotionWatch final
    : public PullStream<grpc::ServerWriteReactor<api::WatchMotionResponse>, api::WatchMotionResponse> {
 public:
  static MotionWatch* start(server::Gateway& gateway, const MotionName& motion, StreamLimit::Place place);

 private:
  MotionWatch(server::Gateway& gateway, const MotionName& motion, StreamLimit::Place place)
      : bus_(gateway.events()), motion_(motion), place_(std::move(place)), reader_(gateway, 0) {}

  void look();
  void show(const stage::Motion& motion, std::uint64_t revision);
  Next next() override;
  void closed() override { subscription_.reset(); }

  server::EventBus& bus_;
  const MotionName motion_;
  const StreamLimit::Place place_;
  FactReader reader_;
  bool looking_ = true;  // the motion as it is now is being fetched; facts from then on come after
  std::optional<api::WatchMotionResponse> due_;
  std::optional<grpc::Status> end_;  // after what is due
  std::unique_ptr<server::WakeUps::Subscription> subscription_;
};

}  // namespace axisgate::rpc
