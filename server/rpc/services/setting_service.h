// SettingService: settings of a controller other than its motion.
#pragma once

#include "axisgate/v1/settings.grpc.pb.h"
#include "server/api/stage/settings.h"

namespace axisgate::rpc {

class SettingService final : public v1::SettingService::CallbackService {
 public:
  // `settings` must outlive this object.
  explicit SettingService(const api::Settings& settings) : settings_(settings) {}

  grpc::ServerUnaryReactor* GetSettings(grpc::CallbackServerContext* context, const v1::GetSettingsRequest* request,
                                        v1::GetSettingsResponse* response) override;
  grpc::ServerUnaryReactor* ChangeSettings(grpc::CallbackServerContext* context,
                                           const v1::ChangeSettingsRequest* request,
                                           v1::ChangeSettingsResponse* response) override;
  grpc::ServerUnaryReactor* SetCoordinates(grpc::CallbackServerContext* context,
                                           const v1::SetCoordinatesRequest* request,
                                           v1::SetCoordinatesResponse* response) override;
  grpc::ServerUnaryReactor* FireTrigger(grpc::CallbackServerContext* context, const v1::FireTriggerRequest* request,
                                        v1::FireTriggerResponse* response) override;
  grpc::ServerUnaryReactor* ResetDevice(grpc::CallbackServerContext* context, const v1::ResetDeviceRequest* request,
                                        v1::ResetDeviceResponse* response) override;

 private:
  const api::Settings& settings_;
};

}  // namespace axisgate::rpc
