// StageService: motion. The front answers stops (call_filter.h).
#include <algorithm>
#include <string>
#include <vector>

#include "axisgate/v1/stage.grpc.pb.h"
#include "server/api/request/axis_names.h"
#include "server/api/stage/jogs.h"
#include "server/api/stage/motions.h"
#include "server/api/stage/paths.h"
#include "server/limits.h"
#include "server/proto/amounts.h"
#include "server/proto/motions.h"
#include "server/proto/pages.h"
#include "server/proto/targets.h"
#include "server/rpc/calls/call.h"
#include "server/rpc/calls/half_close.h"
#include "server/rpc/calls/jog_run.h"
#include "server/rpc/calls/path_run.h"
#include "server/rpc/calls/subscribed_stream.h"
#include "server/rpc/calls/unary_call.h"
#include "server/rpc/services.h"

namespace axisgate::rpc {
namespace {

template <class Response>
api::Answer<api::StartedMotion> answering_with_motion(std::shared_ptr<UnaryCall<Response>> call) {
  return answering<api::StartedMotion>(std::move(call), [](Response& response, const api::StartedMotion& motion) {
    if (motion) *response.mutable_motion() = proto::to_proto(*motion);
  });
}

class StageService final : public v1::StageService::CallbackService {
 public:
  // The referenced objects must outlive this one.
  StageService(const server::Gateway& gateway, const api::Motions& motions, const api::Paths& paths,
               const api::Jogs& jogs, const HalfClose& half_close)
      : gateway_(gateway), motions_(motions), paths_(paths), jogs_(jogs), half_close_(half_close) {}

  grpc::ServerUnaryReactor* Move(grpc::CallbackServerContext* context, const v1::MoveRequest* request,
                                 v1::MoveResponse* response) override {
    const auto call = UnaryCall<v1::MoveResponse>::start(response);
    motions_.move(to_checked_call(*context, *request), request->device(), proto::to_move(*request, names_of(*request)),
                  answering_with_motion(call));
    return call.get();
  }

  grpc::ServerUnaryReactor* Home(grpc::CallbackServerContext* context, const v1::HomeRequest* request,
                                 v1::HomeResponse* response) override {
    const auto call = UnaryCall<v1::HomeResponse>::start(response);
    motions_.home(to_checked_call(*context, *request), request->device(),
                  proto::to_axes(request->axes(), names_of(*request)), answering_with_motion(call));
    return call.get();
  }

  grpc::ServerUnaryReactor* ReturnToOrigin(grpc::CallbackServerContext* context,
                                           const v1::ReturnToOriginRequest* request,
                                           v1::ReturnToOriginResponse* response) override {
    const auto call = UnaryCall<v1::ReturnToOriginResponse>::start(response);
    motions_.return_to_origin(to_checked_call(*context, *request), request->device(),
                              proto::to_axes(request->axes(), names_of(*request)), answering_with_motion(call));
    return call.get();
  }

  grpc::ServerBidiReactor<v1::RunPathRequest, v1::RunPathResponse>* RunPath(
      grpc::CallbackServerContext* context) override {
    auto path = paths_.open(credential_of(*context));
    if (!path) return new EndedStream<grpc::ServerBidiReactor<v1::RunPathRequest, v1::RunPathResponse>>(path.error());
    return PathRun::start(*std::move(path), *context, half_close_, gateway_);
  }

  grpc::ServerUnaryReactor* StartPath(grpc::CallbackServerContext* context, const v1::StartPathRequest* request,
                                      v1::StartPathResponse* response) override {
    const auto call = UnaryCall<v1::StartPathResponse>::start(response);
    std::vector<Result<stage::Segment>> segments;
    const api::AxisNames names = names_of(*request);
    for (const v1::Segment& segment : request->segments()) segments.push_back(proto::to_segment(segment, names));
    paths_.start(to_checked_call(*context, *request), request->device(), std::move(segments),
                 answering_with_motion(call));
    return call.get();
  }

  grpc::ServerUnaryReactor* Scan(grpc::CallbackServerContext* context, const v1::ScanRequest* request,
                                 v1::ScanResponse* response) override {
    const auto call = UnaryCall<v1::ScanResponse>::start(response);
    motions_.scan(to_checked_call(*context, *request), request->device(), proto::to_scan(*request, names_of(*request)),
                  answering_with_motion(call));
    return call.get();
  }

  grpc::ServerBidiReactor<v1::JogRequest, v1::JogResponse>* Jog(grpc::CallbackServerContext* context) override {
    auto jog = jogs_.open(credential_of(*context));
    if (!jog) return new EndedStream<grpc::ServerBidiReactor<v1::JogRequest, v1::JogResponse>>(jog.error());
    return JogRun::start(*std::move(jog), *context, half_close_, gateway_);
  }

  grpc::ServerUnaryReactor* StartJog(grpc::CallbackServerContext* context, const v1::StartJogRequest* request,
                                     v1::StartJogResponse* response) override {
    const auto call = UnaryCall<v1::StartJogResponse>::start(response);
    const auto leave =
        jogs_.start(to_acting_call(*context, *request), request->device(),
                    proto::to_jog_axes(request->axes(), names_of(*request)), answering_with_motion(call));
    if (leave) call->when_cancelled(leave);
    return call.get();
  }

  grpc::ServerUnaryReactor* KeepJog(grpc::CallbackServerContext* context, const v1::KeepJogRequest* request,
                                    v1::KeepJogResponse* response) override {
    const auto call = UnaryCall<v1::KeepJogResponse>::start(response);
    const std::string device = request->motion().substr(0, request->motion().find("/motions/"));
    jogs_.keep(to_call(*context), request->motion(), request->number(),
               proto::to_jog_axes(request->axes(), api::axis_names(gateway_, device)),
               answering<api::KeptJog>(call, [](v1::KeepJogResponse& answer, const api::KeptJog& kept) {
                 *answer.mutable_motion() = proto::to_proto(kept.motion);
                 answer.set_extended(kept.extended);
               }));
    return call.get();
  }

  grpc::ServerUnaryReactor* StopJog(grpc::CallbackServerContext* context, const v1::StopJogRequest* request,
                                    v1::StopJogResponse* response) override {
    const auto call = UnaryCall<v1::StopJogResponse>::start(response);
    jogs_.stop(to_call(*context), request->motion(),
               answering<api::CurrentMotion>(call, [](v1::StopJogResponse& answer, const api::CurrentMotion& motion) {
                 *answer.mutable_motion() = proto::to_proto(motion);
               }));
    return call.get();
  }

  grpc::ServerUnaryReactor* GetMotion(grpc::CallbackServerContext* context, const v1::GetMotionRequest* request,
                                      v1::GetMotionResponse* response) override {
    const auto call = UnaryCall<v1::GetMotionResponse>::start(response);
    motions_.get(
        to_call(*context), request->motion(),
        answering<api::CurrentMotion>(call, [](v1::GetMotionResponse& answer, const api::CurrentMotion& motion) {
          *answer.mutable_motion() = proto::to_proto(motion);
        }));
    return call.get();
  }

  grpc::ServerUnaryReactor* ListMotions(grpc::CallbackServerContext* context, const v1::ListMotionsRequest* request,
                                        v1::ListMotionsResponse* response) override {
    using Motions = std::vector<api::CurrentMotion>;
    const auto call = UnaryCall<v1::ListMotionsResponse>::start(response);
    if (const auto good = proto::check_page(request->page_size(), request->page_token()); !good)
      return call->refuse(good.error());
    motions_.list(to_call(*context), request->device(),
                  answering<Motions>(call, [asked = *request](v1::ListMotionsResponse& answer, Motions motions) {
                    proto::fill_page(asked, std::move(motions), answer);
                  }));
    return call.get();
  }

  grpc::ServerWriteReactor<v1::WatchMotionResponse>* WatchMotion(grpc::CallbackServerContext* context,
                                                                 const v1::WatchMotionRequest* request) override {
    return serve<v1::WatchMotionResponse>(motions_.watch(to_call(*context), request->motion()),
                                          [](v1::WatchMotionResponse& response, const api::CurrentMotion& motion) {
                                            *response.mutable_motion() = proto::to_proto(motion);
                                          });
  }

  grpc::ServerUnaryReactor* WaitMotion(grpc::CallbackServerContext* context, const v1::WaitMotionRequest* request,
                                       v1::WaitMotionResponse* response) override {
    const auto call = UnaryCall<v1::WaitMotionResponse>::start(response);
    const Duration longest = request->has_max_wait() ? proto::to_span(request->max_wait()) : server::kRequestLimit;
    const auto leave = motions_.wait(
        to_call(*context), request->motion(), std::min(longest, server::kMotionWaitMax),
        answering<api::CurrentMotion>(call, [](v1::WaitMotionResponse& answer, const api::CurrentMotion& motion) {
          *answer.mutable_motion() = proto::to_proto(motion);
        }));
    if (leave) call->when_cancelled(leave);
    return call.get();
  }

  grpc::ServerUnaryReactor* CancelMotion(grpc::CallbackServerContext* context, const v1::CancelMotionRequest* request,
                                         v1::CancelMotionResponse* response) override {
    const auto call = UnaryCall<v1::CancelMotionResponse>::start(response);
    motions_.cancel(to_acting_call(*context, *request), request->motion(), answering(call));
    return call.get();
  }

 private:
  template <class Request>
  api::AxisNames names_of(const Request& request) const {
    return api::axis_names(gateway_, request.device());
  }

  const server::Gateway& gateway_;
  const api::Motions& motions_;
  const api::Paths& paths_;
  const api::Jogs& jogs_;
  const HalfClose& half_close_;
};

}  // namespace

std::unique_ptr<grpc::Service> stage_service(const ServiceParts& parts) {
  return std::make_unique<StageService>(parts.gateway, parts.api.motions, parts.api.paths, parts.api.jogs,
                                        parts.half_close);
}

}  // namespace axisgate::rpc
