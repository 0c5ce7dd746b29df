#include "server/rpc/calls/path_run.h"

#include <utility>
#include <variant>

#include "server/proto/digest.h"
#include "server/proto/motions.h"
#include "server/proto/targets.h"
#include "server/rpc/calls/call.h"
#include "server/rpc/calls/unreadable.h"

namespace axisgate::rpc {
namespace {

constexpr const char* kRunPathMethod = "/axisgate.v1.StageService/RunPath";

void fill_path_step(v1::RunPathResponse& response, const api::PathStep& step) {
  if (const auto* motion = std::get_if<api::CurrentMotion>(&step.what)) {
    *response.mutable_motion() = proto::to_proto(*motion);
  } else {
    *response.mutable_progress() = proto::to_proto(step.device, std::get<stage::PathProgress>(step.what));
  }
}

}  // namespace

PathRun* PathRun::start(std::shared_ptr<api::Path> path, const grpc::CallbackServerContext& context,
                        const HalfClose& half_close, const server::Gateway& gateway) {
  const auto run = std::make_shared<PathRun>(std::move(path), context, half_close, gateway);
  run->serve();
  run->StartRead(run->incoming_.marked());
  return run.get();
}

PathRun::PathRun(std::shared_ptr<api::Path> path, const grpc::CallbackServerContext& context,
                 const HalfClose& half_close, const server::Gateway& gateway)
    : SubscribedStream(path, fill_path_step),
      path_(std::move(path)),
      context_(context),
      half_close_(half_close),
      gateway_(gateway) {}

void PathRun::OnReadDone(bool ok) {
  if (!ok && incoming_.unreadable()) {
    path_->refuse_part(not_readable(kRunPathMethod));
    return;
  }
  if (!ok) return half_close_.wait([path = path_, digest = digest_] { path->run(digest); });
  if (take()) StartRead(incoming_.marked());
}

bool PathRun::take() {
  if (incoming_->has_header()) {
    digest_ = proto::digest_of(incoming_->header());
    names_ = api::axis_names(gateway_, incoming_->header().device());
    return path_->start(to_checked_call(context_, incoming_->header()), incoming_->header().device());
  }
  if (incoming_->has_segment()) {
    digest_ = proto::digest_of(digest_, incoming_->segment());
    return path_->add(proto::to_segment(incoming_->segment(), names_));
  }
  return path_->refuse_part({.reason = Reason::invalid_request, .message = "a part of the path is empty"});
}

void PathRun::OnCancel() {
  path_->break_off();
  SubscribedStream::OnCancel();
}

}  // namespace axisgate::rpc
