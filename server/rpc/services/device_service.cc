// DeviceService: the list of devices and their states.
#include "axisgate/v1/device.grpc.pb.h"
#include "server/api/looking/devices.h"
#include "server/api/request/axis_names.h"
#include "server/proto/amounts.h"
#include "server/proto/to_proto.h"
#include "server/rpc/calls/call.h"
#include "server/rpc/calls/subscribed_stream.h"
#include "server/rpc/calls/unary_call.h"
#include "server/rpc/services.h"

namespace axisgate::rpc {
namespace {

class DeviceService final : public v1::DeviceService::CallbackService {
 public:
  // The referenced objects must outlive this one.
  DeviceService(const server::Gateway& gateway, const api::Devices& devices) : gateway_(gateway), devices_(devices) {}

  // The front answers ListDevices and GetDevice (own_answers.h).
  grpc::ServerWriteReactor<v1::WatchDeviceResponse>* WatchDevice(grpc::CallbackServerContext* context,
                                                                 const v1::WatchDeviceRequest* request) override {
    return serve<v1::WatchDeviceResponse>(
        devices_.watch(to_call(*context), request->device(), proto::to_span(request->min_interval())),
        [](v1::WatchDeviceResponse& response, const api::DeviceState& now) {
          *response.mutable_device() = proto::to_proto(*now.device, *now.state);
        });
  }

  grpc::ServerUnaryReactor* ClearErrors(grpc::CallbackServerContext* context, const v1::ClearErrorsRequest* request,
                                        v1::ClearErrorsResponse* response) override {
    const auto call = UnaryCall<v1::ClearErrorsResponse>::start(response);
    devices_.clear_errors(to_checked_call(*context, *request), request->device(),
                          proto::to_axes(request->axes(), api::axis_names(gateway_, request->device())),
                          answering(call));
    return call.get();
  }

  grpc::ServerUnaryReactor* WithdrawStop(grpc::CallbackServerContext* context, const v1::WithdrawStopRequest* request,
                                         v1::WithdrawStopResponse* response) override {
    const auto call = UnaryCall<v1::WithdrawStopResponse>::start(response);
    devices_.withdraw_stop(to_acting_call(*context, *request), request->stop(), answering(call));
    return call.get();
  }

 private:
  const server::Gateway& gateway_;
  const api::Devices& devices_;
};

}  // namespace

std::unique_ptr<grpc::Service> device_service(const ServiceParts& parts) {
  return std::make_unique<DeviceService>(parts.gateway, parts.api.devices);
}

}  // namespace axisgate::rpc
