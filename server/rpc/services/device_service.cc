#include "server/rpc/services/device_service.h"

#include "server/proto/amounts.h"
#include "server/proto/to_proto.h"
#include "server/rpc/calls/call.h"
#include "server/rpc/calls/subscribed_stream.h"
#include "server/rpc/calls/unary_call.h"

namespace axisgate::rpc {
grpc::ServerWriteReactor<v1::WatchDeviceResponse>* DeviceService::WatchDevice(grpc::CallbackServerContext* context,
                                                                              const v1::WatchDeviceRequest* request) {
  return serve<v1::WatchDeviceResponse>(
      devices_.watch(to_call(*context), request->name(), proto::to_span(request->min_interval())),
      [](v1::WatchDeviceResponse& response, const api::DeviceState& now) {
        *response.mutable_device() = proto::to_proto(*now.device, *now.state);
      });
}

grpc::ServerUnaryReactor* DeviceService::ClearErrors(grpc::CallbackServerContext* context,
                                                     const v1::ClearErrorsRequest* request,
                                                     v1::ClearErrorsResponse* response) {
  const auto call = UnaryCall<v1::ClearErrorsResponse>::start(response);
  devices_.clear_errors(to_checked_call(*context, *request), request->name(), proto::to_axes(request->axes()),
                        answering(call));
  return call.get();
}

grpc::ServerUnaryReactor* DeviceService::WithdrawStop(grpc::CallbackServerContext* context,
                                                      const v1::WithdrawStopRequest* request,
                                                      v1::WithdrawStopResponse* response) {
  const auto call = UnaryCall<v1::WithdrawStopResponse>::start(response);
  devices_.withdraw_stop(to_call(*context, request->context()), request->name(), answering(call));
  return call.get();
}

}  // namespace axisgate::rpc
