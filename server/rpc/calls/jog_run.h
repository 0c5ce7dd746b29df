// The call of Jog: axes run as long as the client keeps sending.
#pragma once

#include <grpcpp/server_context.h>
#include <grpcpp/support/server_callback.h>

#include <memory>

#include "axisgate/v1/stage.pb.h"
#include "server/api/request/axis_names.h"
#include "server/api/stage/jogs.h"
#include "server/rpc/calls/half_close.h"
#include "server/rpc/calls/incoming.h"
#include "server/rpc/calls/subscribed_stream.h"

namespace axisgate::rpc {

// The stream reads messages even if the client does not read the answers: such a client still keeps its jog alive.
class JogRun final : public SubscribedStream<grpc::ServerBidiReactor<v1::JogRequest, v1::JogResponse>, v1::JogResponse,
                                             api::CurrentMotion> {
 public:
  // `context` is gRPC's and lives as long as the call. `gateway` must outlive this object.
  static JogRun* start(std::shared_ptr<api::Jog> jog, const grpc::CallbackServerContext& context,
                       const HalfClose& half_close, const server::Gateway& gateway);

  JogRun(std::shared_ptr<api::Jog> jog, const grpc::CallbackServerContext& context, const HalfClose& half_close,
         const server::Gateway& gateway);
  void OnReadDone(bool ok) override;
  void OnCancel() override;

 private:
  bool take();

  const std::shared_ptr<api::Jog> jog_;
  const grpc::CallbackServerContext& context_;
  const HalfClose& half_close_;
  const server::Gateway& gateway_;
  Incoming<v1::JogRequest> incoming_;
  api::AxisNames names_;  // of the device of the first message
  bool started_ = false;  // the first message has been received
};

}  // namespace axisgate::rpc
