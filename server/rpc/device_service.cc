#include "server/rpc/device_service.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>

#include "server/rpc/amounts.h"
#include "server/rpc/call.h"
#include "server/rpc/device_watch.h"
#include "server/rpc/ended_stream.h"
#include "server/rpc/news.h"
#include "server/rpc/targets.h"
#include "server/rpc/unary_call.h"

namespace axisgate::rpc {
namespace {

using stage::StageController;

constexpr Duration kIntervalMin = std::chrono::milliseconds(10);
constexpr Duration kDurationMax = std::chrono::hours(24);

// Clamped, so that no caller's duration overflows nanoseconds.
Duration to_duration(const google::protobuf::Duration& duration) {
  const std::int64_t seconds = std::clamp<std::int64_t>(duration.seconds(), 0, 24 * 3600);
  return std::clamp<Duration>(std::chrono::seconds(seconds) + std::chrono::nanoseconds(duration.nanos()),
                              Duration::zero(), kDurationMax);
}

}  // namespace

grpc::ServerUnaryReactor* DeviceService::ListDevices(grpc::CallbackServerContext*, const api::ListDevicesRequest*,
                                                     api::ListDevicesResponse* response) {
  const auto call = UnaryCall<api::ListDevicesResponse>::start(response);
  call->answer([&](api::ListDevicesResponse& answer) {
    for (const auto& device : gateway_.devices()) {
      *answer.add_devices() = to_proto(*device, *device->newest_state().get().value);
    }
  });
  return call.get();
}

grpc::ServerUnaryReactor* DeviceService::GetDevice(grpc::CallbackServerContext* context,
                                                   const api::GetDeviceRequest* request,
                                                   api::GetDeviceResponse* response) {
  const auto call = UnaryCall<api::GetDeviceResponse>::start(response);
  const Result<server::Device*> device = find_device(gateway_, request->name());
  if (!device) return call->refuse(device.error());
  const auto tell = [call, &device = **device](const stage::State& state) {
    call->answer([&](api::GetDeviceResponse& answer) { *answer.mutable_device() = to_proto(device, state); });
  };
  if (!request->has_max_age()) {
    (*device)->post([tell](StageController& controller, TimePoint) { tell(controller.state()); });
    return call.get();
  }
  (*device)->post([call, tell, max_age = to_duration(request->max_age()), asked = question_context(*context)](
                      StageController& controller, TimePoint now) {
    controller.refresh(max_age, asked, now, [call, tell](const Result<stage::State>& state) {
      state ? tell(*state) : static_cast<void>(call->refuse(state.error()));
    });
  });
  return call.get();
}

grpc::ServerWriteReactor<api::WatchDeviceResponse>* DeviceService::WatchDevice(grpc::CallbackServerContext*,
                                                                               const api::WatchDeviceRequest* request) {
  const Result<server::Device*> device = find_device(gateway_, request->name());
  if (!device) return new EndedStream<api::WatchDeviceResponse>(device.error());
  Result<StreamLimit::Place> place = streams_.take();
  if (!place) return new EndedStream<api::WatchDeviceResponse>(place.error());
  const Duration interval = std::max(kIntervalMin, to_duration(request->min_interval()));
  return DeviceWatch::start(gateway_, **device, interval, *std::move(place));
}

grpc::ServerUnaryReactor* DeviceService::ClearErrors(grpc::CallbackServerContext* context,
                                                     const api::ClearErrorsRequest* request,
                                                     api::ClearErrorsResponse* response) {
  const auto call = UnaryCall<api::ClearErrorsResponse>::start(response);
  const Result<server::Device*> device = find_device(gateway_, request->name());
  if (!device) return call->refuse(device.error());
  const Result<stage::AxisSet> named = to_axes(request->axes());
  if (!named) return call->refuse(named.error());
  const Result<stage::RequestContext> asked = mutation_context(*context, request->context());
  if (!asked) return call->refuse(asked.error());
  (*device)->post([call, named = *named, asked = *asked, validate_only = request->validate_only()](
                      StageController& controller, TimePoint now) {
    const Result<stage::AxisSet> axes = controllable_axes(named, controller.state());
    if (!axes) {
      call->refuse(axes.error());
    } else if (validate_only) {
      call->answer([](api::ClearErrorsResponse&) {});
    } else {
      controller.clear_errors(*axes, asked, now, [call](const Result<void>& done) {
        done ? call->answer([](api::ClearErrorsResponse&) {}) : static_cast<void>(call->refuse(done.error()));
      });
    }
  });
  return call.get();
}

}  // namespace axisgate::rpc
