// SettingService: settings of a controller other than its motion.
#include "axisgate/v1/settings.grpc.pb.h"
#include "server/api/request/axis_names.h"
#include "server/api/stage/settings.h"
#include "server/proto/settings.h"
#include "server/rpc/calls/call.h"
#include "server/rpc/calls/unary_call.h"
#include "server/rpc/services.h"

namespace axisgate::rpc {
namespace {

class SettingService final : public v1::SettingService::CallbackService {
 public:
  // The referenced objects must outlive this one.
  SettingService(const server::Gateway& gateway, const api::Settings& settings)
      : gateway_(gateway), settings_(settings) {}

  grpc::ServerUnaryReactor* GetSettings(grpc::CallbackServerContext* context, const v1::GetSettingsRequest* request,
                                        v1::GetSettingsResponse* response) override {
    const auto call = UnaryCall<v1::GetSettingsResponse>::start(response);
    settings_.get(
        to_call(*context), request->device(),
        answering<stage::Settings>(call, [](v1::GetSettingsResponse& answer, const stage::Settings& settings) {
          *answer.mutable_settings() = proto::to_proto(settings);
        }));
    return call.get();
  }

  grpc::ServerUnaryReactor* ChangeSettings(grpc::CallbackServerContext* context,
                                           const v1::ChangeSettingsRequest* request,
                                           v1::ChangeSettingsResponse* response) override {
    const auto call = UnaryCall<v1::ChangeSettingsResponse>::start(response);
    settings_.change(to_checked_call(*context, *request), request->device(),
                     proto::to_change(request->settings(), api::axis_names(gateway_, request->device())),
                     answering(call));
    return call.get();
  }

  grpc::ServerUnaryReactor* SetCoordinates(grpc::CallbackServerContext* context,
                                           const v1::SetCoordinatesRequest* request,
                                           v1::SetCoordinatesResponse* response) override {
    const auto call = UnaryCall<v1::SetCoordinatesResponse>::start(response);
    settings_.set_coordinates(to_checked_call(*context, *request), request->device(),
                              proto::to_coordinates(*request, api::axis_names(gateway_, request->device())),
                              answering(call));
    return call.get();
  }

  grpc::ServerUnaryReactor* FireTrigger(grpc::CallbackServerContext* context, const v1::FireTriggerRequest* request,
                                        v1::FireTriggerResponse* response) override {
    const auto call = UnaryCall<v1::FireTriggerResponse>::start(response);
    settings_.fire_trigger(to_checked_call(*context, *request), request->device(), answering(call));
    return call.get();
  }

  grpc::ServerUnaryReactor* ResetDevice(grpc::CallbackServerContext* context, const v1::ResetDeviceRequest* request,
                                        v1::ResetDeviceResponse* response) override {
    const auto call = UnaryCall<v1::ResetDeviceResponse>::start(response);
    settings_.reset(to_checked_call(*context, *request), request->device(), answering(call));
    return call.get();
  }

 private:
  const server::Gateway& gateway_;
  const api::Settings& settings_;
};

}  // namespace

std::unique_ptr<grpc::Service> setting_service(const ServiceParts& parts) {
  return std::make_unique<SettingService>(parts.gateway, parts.api.settings);
}

}  // namespace axisgate::rpc
