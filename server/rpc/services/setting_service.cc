#include "server/rpc/services/setting_service.h"

#include "server/proto/settings.h"
#include "server/rpc/calls/call.h"
#include "server/rpc/calls/unary_call.h"

namespace axisgate::rpc {

grpc::ServerUnaryReactor* SettingService::GetSettings(grpc::CallbackServerContext* context,
                                                      const v1::GetSettingsRequest* request,
                                                      v1::GetSettingsResponse* response) {
  const auto call = UnaryCall<v1::GetSettingsResponse>::start(response);
  settings_.get(to_call(*context), request->device(),
                answering<stage::Settings>(call, [](v1::GetSettingsResponse& answer, const stage::Settings& settings) {
                  *answer.mutable_settings() = proto::to_proto(settings);
                }));
  return call.get();
}

grpc::ServerUnaryReactor* SettingService::ChangeSettings(grpc::CallbackServerContext* context,
                                                         const v1::ChangeSettingsRequest* request,
                                                         v1::ChangeSettingsResponse* response) {
  const auto call = UnaryCall<v1::ChangeSettingsResponse>::start(response);
  settings_.change(to_checked_call(*context, *request), request->device(), proto::to_change(request->settings()),
                   answering(call));
  return call.get();
}

grpc::ServerUnaryReactor* SettingService::SetCoordinates(grpc::CallbackServerContext* context,
                                                         const v1::SetCoordinatesRequest* request,
                                                         v1::SetCoordinatesResponse* response) {
  const auto call = UnaryCall<v1::SetCoordinatesResponse>::start(response);
  settings_.set_coordinates(to_checked_call(*context, *request), request->device(), proto::to_coordinates(*request),
                            answering(call));
  return call.get();
}

grpc::ServerUnaryReactor* SettingService::FireTrigger(grpc::CallbackServerContext* context,
                                                      const v1::FireTriggerRequest* request,
                                                      v1::FireTriggerResponse* response) {
  const auto call = UnaryCall<v1::FireTriggerResponse>::start(response);
  settings_.fire_trigger(to_checked_call(*context, *request), request->device(), answering(call));
  return call.get();
}

grpc::ServerUnaryReactor* SettingService::ResetDevice(grpc::CallbackServerContext* context,
                                                      const v1::ResetDeviceRequest* request,
                                                      v1::ResetDeviceResponse* response) {
  const auto call = UnaryCall<v1::ResetDeviceResponse>::start(response);
  settings_.reset(to_checked_call(*context, *request), request->device(), answering(call));
  return call.get();
}

}  // namespace axisgate::rpc
