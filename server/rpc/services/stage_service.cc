#include "server/rpc/services/stage_service.h"

#include <vector>

#include "server/proto/amounts.h"
#include "server/proto/targets.h"
#include "server/proto/to_proto.h"
#include "server/rpc/calls/call.h"
#include "server/rpc/calls/jog_run.h"
#include "server/rpc/calls/path_run.h"
#include "server/rpc/calls/subscribed_stream.h"
#include "server/rpc/calls/unary_call.h"

namespace axisgate::rpc {
namespace {

template <class Response>
api::Answer<api::StartedMotion> answering_with_motion(std::shared_ptr<UnaryCall<Response>> call) {
  return answering<api::StartedMotion>(std::move(call), [](Response& response, const api::StartedMotion& motion) {
    if (motion) *response.mutable_motion() = proto::to_proto(*motion);
  });
}

}  // namespace

grpc::ServerUnaryReactor* StageService::Move(grpc::CallbackServerContext* context, const v1::MoveRequest* request,
                                             v1::MoveResponse* response) {
  const auto call = UnaryCall<v1::MoveResponse>::start(response);
  motions_.move(to_checked_call(*context, *request), request->device(), proto::to_move(*request),
                answering_with_motion(call));
  return call.get();
}

grpc::ServerUnaryReactor* StageService::Home(grpc::CallbackServerContext* context, const v1::HomeRequest* request,
                                             v1::HomeResponse* response) {
  const auto call = UnaryCall<v1::HomeResponse>::start(response);
  motions_.home(to_checked_call(*context, *request), request->device(), proto::to_axes(request->axes()),
                answering_with_motion(call));
  return call.get();
}

grpc::ServerUnaryReactor* StageService::ReturnToOrigin(grpc::CallbackServerContext* context,
                                                       const v1::ReturnToOriginRequest* request,
                                                       v1::ReturnToOriginResponse* response) {
  const auto call = UnaryCall<v1::ReturnToOriginResponse>::start(response);
  motions_.return_to_origin(to_checked_call(*context, *request), request->device(), proto::to_axes(request->axes()),
                            answering_with_motion(call));
  return call.get();
}

grpc::ServerBidiReactor<v1::RunPathRequest, v1::RunPathResponse>* StageService::RunPath(
    grpc::CallbackServerContext* context) {
  auto path = paths_.open(credential_of(*context));
  if (!path) return new EndedStream<grpc::ServerBidiReactor<v1::RunPathRequest, v1::RunPathResponse>>(path.error());
  return PathRun::start(*std::move(path), *context, half_close_);
}

grpc::ServerUnaryReactor* StageService::Scan(grpc::CallbackServerContext* context, const v1::ScanRequest* request,
                                             v1::ScanResponse* response) {
  const auto call = UnaryCall<v1::ScanResponse>::start(response);
  motions_.scan(to_checked_call(*context, *request), request->device(), proto::to_scan(*request),
                answering_with_motion(call));
  return call.get();
}

grpc::ServerBidiReactor<v1::JogRequest, v1::JogResponse>* StageService::Jog(grpc::CallbackServerContext* context) {
  auto jog = jogs_.open(credential_of(*context));
  if (!jog) return new EndedStream<grpc::ServerBidiReactor<v1::JogRequest, v1::JogResponse>>(jog.error());
  return JogRun::start(*std::move(jog), *context, half_close_);
}

grpc::ServerUnaryReactor* StageService::GetMotion(grpc::CallbackServerContext* context,
                                                  const v1::GetMotionRequest* request,
                                                  v1::GetMotionResponse* response) {
  const auto call = UnaryCall<v1::GetMotionResponse>::start(response);
  motions_.get(to_call(*context), request->name(),
               answering<api::CurrentMotion>(call, [](v1::GetMotionResponse& answer, const api::CurrentMotion& motion) {
                 *answer.mutable_motion() = proto::to_proto(motion);
               }));
  return call.get();
}

grpc::ServerUnaryReactor* StageService::ListMotions(grpc::CallbackServerContext* context,
                                                    const v1::ListMotionsRequest* request,
                                                    v1::ListMotionsResponse* response) {
  using Motions = std::vector<api::CurrentMotion>;
  const auto call = UnaryCall<v1::ListMotionsResponse>::start(response);
  motions_.list(to_call(*context), request->device(),
                answering<Motions>(call, [](v1::ListMotionsResponse& answer, const Motions& motions) {
                  for (const api::CurrentMotion& motion : motions) *answer.add_motions() = proto::to_proto(motion);
                }));
  return call.get();
}

grpc::ServerWriteReactor<v1::WatchMotionResponse>* StageService::WatchMotion(grpc::CallbackServerContext* context,
                                                                             const v1::WatchMotionRequest* request) {
  return serve<v1::WatchMotionResponse>(motions_.watch(to_call(*context), request->name()),
                                        [](v1::WatchMotionResponse& response, const api::CurrentMotion& motion) {
                                          *response.mutable_motion() = proto::to_proto(motion);
                                        });
}

grpc::ServerUnaryReactor* StageService::CancelMotion(grpc::CallbackServerContext* context,
                                                     const v1::CancelMotionRequest* request,
                                                     v1::CancelMotionResponse* response) {
  const auto call = UnaryCall<v1::CancelMotionResponse>::start(response);
  motions_.cancel(to_call(*context, request->context()), request->name(), answering(call));
  return call.get();
}

}  // namespace axisgate::rpc
