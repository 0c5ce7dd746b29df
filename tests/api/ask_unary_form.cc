#include <vector>

#include "tests/api/ask.h"
#include "tests/api/ask_parts.h"

namespace axisgate::api {
namespace {

Reason start_jog(World& world, const Call& call) {
  Asking<StartedMotion> started;
  (void)world.api->jogs.start(call, kDevice, std::vector<JogAxis>{{.axis = 1, .direction = 1}}, started.answer());
  const Result<StartedMotion> motion = started.get();
  if (!motion) return motion.error().reason;
  Asking<CurrentMotion> stopped;
  world.api->jogs.stop(call, motion_name("turn", (*motion)->motion.id), stopped.answer());
  const Reason reason = stopped.reason();
  EXPECT_TRUE(world.all_ended());
  return reason;
}

Reason start_path(World& world, const Call& call) {
  std::vector<Result<stage::Segment>> segments;
  segments.push_back(stage::Segment{
      .moves = {{.axis = 1, .distance = pulses(10), .profile = {}}}, .speed = {}, .acceleration_ms = {}});
  Asking<StartedMotion> started;
  world.api->paths.start(call, kDevice, std::move(segments), started.answer());
  return started.reason();
}

}  // namespace

bool is_unary_form(RequestKind kind) {
  using Kind = RequestKind;
  return kind == Kind::renew_lease || kind == Kind::start_path || kind == Kind::start_jog || kind == Kind::keep_jog ||
         kind == Kind::stop_jog || kind == Kind::wait_motion || kind == Kind::send_job_piece;
}

Reason ask_unary_form(World& world, RequestKind kind, const Call& call) {
  switch (kind) {
    case RequestKind::renew_lease: {
      Asking<server::Lease> lease;
      world.api->leases.renew(call, kDevice, lease.answer());
      return lease.reason();
    }
    case RequestKind::start_path:
      return start_path(world, call);
    case RequestKind::start_jog:
      return start_jog(world, call);
    case RequestKind::keep_jog: {
      Asking<KeptJog> kept;
      world.api->jogs.keep(call, kUnknownMotion, 1, std::vector<JogAxis>(), kept.answer());
      return kept.reason();
    }
    case RequestKind::stop_jog: {
      Asking<CurrentMotion> stopped;
      world.api->jogs.stop(call, kUnknownMotion, stopped.answer());
      return stopped.reason();
    }
    case RequestKind::send_job_piece: {
      Asking<PieceTaken> taken;
      Call named = call;
      named.request_id = "piece-1";
      world.api->mill.pieces.take(named, kDevice, JobToSend{}, {}, taken.answer());
      return taken.reason();
    }
    default: {
      Asking<CurrentMotion> ended;
      (void)world.api->motions.wait(call, kUnknownMotion, std::chrono::seconds(20), ended.answer());
      return ended.reason();
    }
  }
}

}  // namespace axisgate::api
