#include "server/rpc/stage_service.h"

#include <memory>
#include <utility>

#include "device/stage/envelope.h"
#include "server/rpc/amounts.h"
#include "server/rpc/call.h"
#include "server/rpc/ended_stream.h"
#include "server/rpc/jog_run.h"
#include "server/rpc/motion_watch.h"
#include "server/rpc/news.h"
#include "server/rpc/path_run.h"
#include "server/rpc/targets.h"
#include "server/rpc/unary_call.h"

namespace axisgate::rpc {
namespace {

using stage::StageController;

// Answers a call with the motion that it started, or with what kept it from it. Called on the device's strand.
template <class Response>
StageController::OnStarted tell_started(std::shared_ptr<UnaryCall<Response>> call, server::Device& device) {
  return [call = std::move(call), &device](const Result<stage::Motion>& motion) {
    if (!motion) {
      call->refuse(motion.error());
      return;
    }
    call->answer([&](Response& answer) {
      *answer.mutable_motion() = to_proto(device.name(), *motion, device.motion_revision(motion->id));
    });
  };
}

Result<void> check_home(const stage::HomeRequest& home, const stage::Profile& profile, const stage::State& state) {
  const auto axes = controllable_axes(home.axes, state);
  if (!axes) return tl::unexpected(axes.error());
  const stage::Envelope envelope(profile, state, home.context.who, "");
  for (const int axis : axes->list()) {
    if (const auto good = envelope.check_stage(axis); !good) return good;
  }
  return {};
}

// Home and ReturnToOrigin, which differ in the controller's member alone.
template <class Response, class Request>
grpc::ServerUnaryReactor* home(server::Gateway& gateway, const server::Access& access,
                               const grpc::CallbackServerContext& context, const Request& request, Response* response,
                               void (StageController::*start)(stage::HomeRequest, TimePoint,
                                                              StageController::OnStarted)) {
  const auto call = UnaryCall<Response>::start(response);
  const Result<server::Device*> device = find_device(gateway, request.device());
  if (!device) return call->refuse(device.error());
  const Result<stage::AxisSet> named = to_axes(request.axes());
  if (!named) return call->refuse(named.error());
  Result<stage::RequestContext> asked = motion_context(context, request.context(), access);
  if (!asked) return call->refuse(asked.error());
  (*device)->post([call, start, &device = **device, validate_only = request.validate_only(),
                   home = stage::HomeRequest{*named, *std::move(asked)}](StageController& controller, TimePoint now) {
    if (!validate_only) {
      (controller.*start)(home, now, tell_started(call, device));
    } else if (const auto checked = check_home(home, device.profile(), controller.state()); !checked) {
      call->refuse(checked.error());
    } else {
      call->answer([](Response&) {});
    }
  });
  return call.get();
}

template <class Response>
StageController::OnStopped tell_stopped(std::shared_ptr<UnaryCall<Response>> call) {
  return [call = std::move(call)](const stage::StopReport& report) {
    call->answer([&](Response& answer) { fill(answer, report); });
  };
}

}  // namespace

grpc::ServerUnaryReactor* StageService::Move(grpc::CallbackServerContext* context, const api::MoveRequest* request,
                                             api::MoveResponse* response) {
  const auto call = UnaryCall<api::MoveResponse>::start(response);
  const Result<server::Device*> device = find_device(gateway_, request->device());
  if (!device) return call->refuse(device.error());
  const Result<stage::RequestContext> asked = motion_context(*context, request->context(), access_);
  if (!asked) return call->refuse(asked.error());
  // The request is copied: a caller who leaves takes gRPC's own with it.
  (*device)->post(
      [call, &device = **device, request = *request, asked = *asked](StageController& controller, TimePoint now) {
        Result<stage::MoveRequest> move = to_move(request, controller.state(), asked);
        if (!move) {
          call->refuse(move.error());
        } else if (!request.validate_only()) {
          controller.move(*std::move(move), now, tell_started(call, device));
        } else if (const Result<void> checked = controller.check(*move); !checked) {
          call->refuse(checked.error());
        } else {
          call->answer([](api::MoveResponse&) {});
        }
      });
  return call.get();
}

grpc::ServerUnaryReactor* StageService::Home(grpc::CallbackServerContext* context, const api::HomeRequest* request,
                                             api::HomeResponse* response) {
  return home(gateway_, access_, *context, *request, response, &StageController::home);
}

grpc::ServerUnaryReactor* StageService::ReturnToOrigin(grpc::CallbackServerContext* context,
                                                       const api::ReturnToOriginRequest* request,
                                                       api::ReturnToOriginResponse* response) {
  return home(gateway_, access_, *context, *request, response, &StageController::return_to_origin);
}

grpc::ServerBidiReactor<api::RunPathRequest, api::RunPathResponse>* StageService::RunPath(
    grpc::CallbackServerContext* context) {
  return PathRun::start(gateway_, access_, *context, paths_.take());
}

grpc::ServerUnaryReactor* StageService::Scan(grpc::CallbackServerContext* context, const api::ScanRequest* request,
                                             api::ScanResponse* response) {
  const auto call = UnaryCall<api::ScanResponse>::start(response);
  const Result<server::Device*> device = find_device(gateway_, request->device());
  if (!device) return call->refuse(device.error());
  Result<stage::RequestContext> asked = motion_context(*context, request->context(), access_);
  if (!asked) return call->refuse(asked.error());
  Result<stage::ScanRequest> scan = to_scan(*request, *std::move(asked));
  if (!scan) return call->refuse(scan.error());
  (*device)->post([call, &device = **device, validate_only = request->validate_only(), scan = *std::move(scan)](
                      StageController& controller, TimePoint now) {
    if (!validate_only) {
      controller.scan(scan, now, tell_started(call, device));
    } else if (const Result<void> checked = controller.check(scan); !checked) {
      call->refuse(checked.error());
    } else {
      call->answer([](api::ScanResponse&) {});
    }
  });
  return call.get();
}

grpc::ServerBidiReactor<api::JogRequest, api::JogResponse>* StageService::Jog(grpc::CallbackServerContext* context) {
  return JogRun::start(gateway_, access_, *context, streams_.take());
}

grpc::ServerUnaryReactor* StageService::Stop(grpc::CallbackServerContext* context, const api::StopRequest* request,
                                             api::StopResponse* response) {
  const auto call = UnaryCall<api::StopResponse>::start(response);
  const Result<server::Device*> device = find_device(gateway_, request->device());
  if (!device) return call->refuse(device.error());
  const Result<stage::AxisSet> axes = to_axes(request->axes());
  if (!axes) return call->refuse(axes.error());
  (*device)->post(
      [call, axes = *axes, asked = stop_context(*context, request->context())](
          StageController& controller, TimePoint now) { controller.stop(axes, asked, now, tell_stopped(call)); });
  return call.get();
}

grpc::ServerUnaryReactor* StageService::EmergencyStop(grpc::CallbackServerContext* context,
                                                      const api::EmergencyStopRequest* request,
                                                      api::EmergencyStopResponse* response) {
  const auto call = UnaryCall<api::EmergencyStopResponse>::start(response);
  const Result<server::Device*> device = find_device(gateway_, request->device());
  if (!device) return call->refuse(device.error());
  (*device)->post(
      [call, asked = stop_context(*context, request->context())](StageController& controller, TimePoint now) {
        controller.emergency_stop(asked, now, tell_stopped(call));
      });
  return call.get();
}

grpc::ServerUnaryReactor* StageService::GetMotion(grpc::CallbackServerContext*, const api::GetMotionRequest* request,
                                                  api::GetMotionResponse* response) {
  const auto call = UnaryCall<api::GetMotionResponse>::start(response);
  const Result<MotionName> name = find_motion_name(gateway_, request->name());
  if (!name) return call->refuse(name.error());
  name->device->post([call, name = *name](StageController& controller, TimePoint) {
    tell_started(call, *name.device)(find_motion(controller, name.id));
  });
  return call.get();
}

grpc::ServerUnaryReactor* StageService::ListMotions(grpc::CallbackServerContext*,
                                                    const api::ListMotionsRequest* request,
                                                    api::ListMotionsResponse* response) {
  const auto call = UnaryCall<api::ListMotionsResponse>::start(response);
  const Result<server::Device*> device = find_device(gateway_, request->device());
  if (!device) return call->refuse(device.error());
  (*device)->post([call, &device = **device](StageController& controller, TimePoint) {
    call->answer([&](api::ListMotionsResponse& answer) {
      for (const stage::Motion& motion : controller.motions()) {
        *answer.add_motions() = to_proto(device.name(), motion, device.motion_revision(motion.id));
      }
    });
  });
  return call.get();
}

grpc::ServerWriteReactor<api::WatchMotionResponse>* StageService::WatchMotion(grpc::CallbackServerContext*,
                                                                              const api::WatchMotionRequest* request) {
  using Ended = EndedStream<api::WatchMotionResponse>;
  const Result<MotionName> name = find_motion_name(gateway_, request->name());
  if (!name) return new Ended(name.error());
  Result<StreamLimit::Place> place = streams_.take();
  if (!place) return new Ended(place.error());
  return MotionWatch::start(gateway_, *name, *std::move(place));
}

grpc::ServerUnaryReactor* StageService::CancelMotion(grpc::CallbackServerContext* context,
                                                     const api::CancelMotionRequest* request,
                                                     api::CancelMotionResponse* response) {
  const auto call = UnaryCall<api::CancelMotionResponse>::start(response);
  const Result<MotionName> name = find_motion_name(gateway_, request->name());
  if (!name) return call->refuse(name.error());
  name->device->post([call, id = name->id, asked = stop_context(*context, request->context())](
                         StageController& controller, TimePoint now) {
    controller.cancel_motion(id, asked, now, [call](const Result<void>& done) {
      done ? call->answer([](api::CancelMotionResponse&) {}) : static_cast<void>(call->refuse(done.error()));
    });
  });
  return call.get();
}

}  // namespace axisgate::rpc
