#include "server/rpc/device_service.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <vector>

#include "server/rpc/amounts.h"
#include "server/rpc/call.h"
#include "server/rpc/subscribed_stream.h"
#include "server/rpc/to_proto.h"
#include "server/rpc/unary_call.h"

namespace axisgate::rpc {
namespace {

constexpr Duration kSpanMax = std::chrono::hours(24);

// Clamped: one that is none is no time at all.
Duration to_span(const google::protobuf::Duration& duration) {
  const std::int64_t seconds = std::clamp<std::int64_t>(duration.seconds(), 0, 24 * 3600);
  return std::clamp<Duration>(std::chrono::seconds(seconds) + std::chrono::nanoseconds(duration.nanos()),
                              Duration::zero(), kSpanMax);
}

}  // namespace

grpc::ServerUnaryReactor* DeviceService::GetDevice(grpc::CallbackServerContext* context,
                                                   const v1::GetDeviceRequest* request,
                                                   v1::GetDeviceResponse* response) {
  const auto call = UnaryCall<v1::GetDeviceResponse>::start(response);
  const auto max_age = request->has_max_age() ? std::optional(to_span(request->max_age())) : std::nullopt;
  devices_.get(to_call(*context), request->name(), max_age,
               answering<api::StateNow>(call, [](v1::GetDeviceResponse& answer, const api::StateNow& now) {
                 *answer.mutable_device() = to_proto(*now.device, *now.state);
               }));
  return call.get();
}

grpc::ServerWriteReactor<v1::WatchDeviceResponse>* DeviceService::WatchDevice(grpc::CallbackServerContext* context,
                                                                              const v1::WatchDeviceRequest* request) {
  return serve<v1::WatchDeviceResponse>(
      devices_.watch(to_call(*context), request->name(), to_span(request->min_interval())),
      [](v1::WatchDeviceResponse& response, const api::DeviceState& now) {
        *response.mutable_device() = to_proto(*now.device, *now.state);
      });
}

grpc::ServerUnaryReactor* DeviceService::ClearErrors(grpc::CallbackServerContext* context,
                                                     const v1::ClearErrorsRequest* request,
                                                     v1::ClearErrorsResponse* response) {
  const auto call = UnaryCall<v1::ClearErrorsResponse>::start(response);
  devices_.clear_errors(to_checked_call(*context, *request), request->name(), to_axes(request->axes()),
                        answering(call));
  return call.get();
}

}  // namespace axisgate::rpc
