#include "server/rpc/calls/jog_run.h"

#include <optional>
#include <utility>
#include <vector>

#include "server/proto/motions.h"
#include "server/proto/targets.h"
#include "server/rpc/calls/call.h"
#include "server/rpc/calls/unreadable.h"

namespace axisgate::rpc {
namespace {

constexpr const char* kJogMethod = "/axisgate.v1.StageService/Jog";

}  // namespace

JogRun* JogRun::start(std::shared_ptr<api::Jog> jog, const grpc::CallbackServerContext& context,
                      const HalfClose& half_close, const server::Gateway& gateway) {
  const auto run = std::make_shared<JogRun>(std::move(jog), context, half_close, gateway);
  run->serve();
  run->StartRead(run->incoming_.marked());
  return run.get();
}

JogRun::JogRun(std::shared_ptr<api::Jog> jog, const grpc::CallbackServerContext& context, const HalfClose& half_close,
               const server::Gateway& gateway)
    : SubscribedStream(jog,
                       [](v1::JogResponse& response, const api::CurrentMotion& motion) {
                         *response.mutable_motion() = proto::to_proto(motion);
                       }),
      jog_(std::move(jog)),
      context_(context),
      half_close_(half_close),
      gateway_(gateway) {}

void JogRun::OnReadDone(bool ok) {
  if (!ok && incoming_.unreadable()) return jog_->refuse_part(not_readable(kJogMethod));
  if (!ok) return half_close_.wait([jog = jog_] { jog->finish(); });
  if (take()) StartRead(incoming_.marked());
}

bool JogRun::take() {
  if (!started_) names_ = api::axis_names(gateway_, incoming_->device());
  const auto axes = proto::to_jog_axes(incoming_->axes(), names_);
  if (std::exchange(started_, true)) return jog_->renew(axes);
  api::Call call = to_call(context_, incoming_->context());
  call.digest = proto::digest_of(*incoming_);
  return jog_->start(call, incoming_->device(), axes);
}

void JogRun::OnCancel() {
  jog_->break_off();
  SubscribedStream::OnCancel();
}

}  // namespace axisgate::rpc
