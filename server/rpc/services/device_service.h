// DeviceService: which devices there are and how they are.
#pragma once

#include "axisgate/v1/device.grpc.pb.h"
#include "server/api/looking/devices.h"

namespace axisgate::rpc {

class DeviceService final : public v1::DeviceService::CallbackService {
 public:
  // It outlives this.
  explicit DeviceService(const api::Devices& devices) : devices_(devices) {}

  // ListDevices and GetDevice are the front's (own_answers.h).
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
