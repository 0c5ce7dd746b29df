// SettingService: what a controller is set to beside its motion.
#pragma once

#include "axisgate/v1/settings.grpc.pb.h"
#include "server/access/access.h"
#include "server/gateway.h"

namespace axisgate::rpc {

namespace api = axisgate::v1;

class SettingService final : public api::SettingService::CallbackService {
 public:
  // Both outlive this.
  SettingService(server::Gateway& gateway, const server::Access& access) : gateway_(gateway), access_(access) {}

  grpc::ServerUnaryReactor* GetSettings(grpc::CallbackServerContext* context, const api::GetSettingsRequest* request,
                                        api::GetSettingsResponse* response) override;
  grpc::ServerUnaryReactor* ChangeSettings(grpc::CallbackServerContext* context,
                                           const api::ChangeSettingsRequest* request,
                                           api::ChangeSettingsResponse* response) override;
  grpc::ServerUnaryReactor* SetCoordinates(grpc::CallbackServerContext* context,
                                           const api::SetCoordinatesRequest* request,
                                           api::SetCoordinatesResponse* response) override;
  grpc::ServerUnaryReactor* FireTrigger(grpc::CallbackServerContext* context, const api::FireTriggerRequest* request,
                                        api::FireTriggerResponse* response) override;
  grpc::ServerUnaryReactor* ResetDevice(grpc::CallbackServerContext* context, const api::ResetDeviceRequest* request,
                                        api::ResetDeviceResponse* response) override;

 private:
  template <class Request, class Response, class ToLines>
  grpc::ServerUnaryReactor* change(const grpc::CallbackServerContext& context, const Request& request,
                                   Response* response, ToLines to_lines);

  server::Gateway& gateway_;
  const server::Access& access_;
};

}  // namespace axisgate::rpc
