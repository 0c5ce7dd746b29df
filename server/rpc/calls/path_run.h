// The call of RunPath: receives the whole path, then reports its progress until its outcome.
#pragma once

#include <grpcpp/server_context.h>
#include <grpcpp/support/server_callback.h>

#include <memory>

#include "axisgate/v1/stage.pb.h"
#include "server/api/request/axis_names.h"
#include "server/api/stage/paths.h"
#include "server/rpc/calls/half_close.h"
#include "server/rpc/calls/incoming.h"
#include "server/rpc/calls/subscribed_stream.h"

namespace axisgate::rpc {

class PathRun final : public SubscribedStream<grpc::ServerBidiReactor<v1::RunPathRequest, v1::RunPathResponse>,
                                              v1::RunPathResponse, api::PathStep> {
 public:
  // `context` is gRPC's and lives as long as the call. `gateway` must outlive this object.
  static PathRun* start(std::shared_ptr<api::Path> path, const grpc::CallbackServerContext& context,
                        const HalfClose& half_close, const server::Gateway& gateway);

  PathRun(std::shared_ptr<api::Path> path, const grpc::CallbackServerContext& context, const HalfClose& half_close,
          const server::Gateway& gateway);
  void OnReadDone(bool ok) override;
  void OnCancel() override;

 private:
  bool take();

  const std::shared_ptr<api::Path> path_;
  const grpc::CallbackServerContext& context_;
  const HalfClose& half_close_;
  const server::Gateway& gateway_;
  Incoming<v1::RunPathRequest> incoming_;
  api::AxisNames names_;  // of the device of the header
  std::string digest_;    // of all messages received up to now
};

}  // namespace axisgate::rpc
