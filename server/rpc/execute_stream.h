// The stream of Execute: each line's reply, then the completions that they caused.
#pragma once

#include <grpcpp/support/server_callback.h>

#include <deque>
#include <memory>
#include <optional>

#include "axisgate/v1/command.pb.h"
#include "device/stage/stage_controller.h"
#include "server/gateway.h"
#include "server/rpc/pull_stream.h"
#include "server/rpc/stream_limit.h"

namespace axisgate::rpc {

namespace api = axisgate::v1;

class ExecuteStream final : public PullStream<grpc::ServerWriteReactor<api::ExecuteResponse>, api::ExecuteResponse> {
 public:
  static ExecuteStream* start(server::Gateway& gateway, server::Device& device, stage::ExecuteRequest transaction,
                              Duration timeout, StreamLimit::Place place);

 private:
  explicit ExecuteStream(StreamLimit::Place place) : place_(std::move(place)) {}

  void on_event(const stage::ExecuteEvent& event);
  void end(grpc::Status status);
  Next next() override;

  const StreamLimit::Place place_;
  // Bounded by the transaction: a reply for each of its lines and a completion for each axis they move.
  std::deque<api::ExecuteResponse> due_;
  std::optional<grpc::Status> end_;  // after what is due
};

}  // namespace axisgate::rpc
