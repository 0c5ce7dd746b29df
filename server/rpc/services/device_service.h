// DeviceService: the list of devices and their states.
#pragma once

#include "axisgate/v1/device.grpc.pb.h"
#include "server/api/looking/devices.h"

namespace axisgate::rpc {

class DeviceService final : public v1::DeviceService::CallbackService {
 public:
  // `devices` must outlive this object.
  explicit DeviceService(const api::Devices& devices) : devices_(devices) {}

  // The front answers ListDevices and GetDevice (own_answers.h).
  grpc::ServerWriteReactor<v1::WatchDeviceResponse>* WatchDevice(grpc::CallbackServerContext* context,
                                                                 const v1::WatchDeviceRequest* request) override;
  grpc::ServerUnaryReactor* ClearErrors(grpc::CallbackServerContext* context, const v1::ClearErrorsRequest* request,
                                        v1::ClearErrorsResponse* response) override;
  grpc::ServerUnaryReactor* WithdrawStop(grpc::CallbackServerContext* context, const v1::WithdrawStopRequest* request,
                                         v1::WithdrawStopResponse* response) override;

 private:
  const api::Devices& devices_;
};

}  // namespace axisgate::rpc
