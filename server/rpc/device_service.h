// DeviceService: which devices there are and how they are.
#pragma once

#include "axisgate/v1/device.grpc.pb.h"
#include "server/gateway.h"
#include "server/rpc/stream_limit.h"

namespace axisgate::rpc {

namespace api = axisgate::v1;

class DeviceService final : public api::DeviceService::CallbackService {
 public:
  // Both outlive this.
  DeviceService(server::Gateway& gateway, StreamLimit& streams) : gateway_(gateway), streams_(streams) {}

  grpc::ServerUnaryReactor* ListDevices(grpc::CallbackServerContext* context, const api::ListDevicesRequest* request,
                                        api::ListDevicesResponse* response) override;
  grpc::ServerUnaryReactor* GetDevice(grpc::CallbackServerContext* context, const api::GetDeviceRequest* request,
                                      api::GetDeviceResponse* response) override;
  grpc::ServerWriteReactor<api::WatchDeviceResponse>* WatchDevice(grpc::CallbackServerContext* context,
                                                                  const api::WatchDeviceRequest* request) override;
  grpc::ServerUnaryReactor* ClearErrors(grpc::CallbackServerContext* context, const api::ClearErrorsRequest* request,
                                        api::ClearErrorsResponse* response) override;

 private:
  server::Gateway& gateway_;
  StreamLimit& streams_;
};

}  // namespace axisgate::rpc
