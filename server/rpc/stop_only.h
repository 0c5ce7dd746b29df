// What a connection of the reserve is served: stops, and the names of the devices; anything else is refused at once.
#pragma once

#include <google/protobuf/descriptor.h>
#include <grpcpp/generic/async_generic_service.h>

#include <algorithm>
#include <initializer_list>
#include <string>
#include <string_view>

#include "axisgate/v1/device.grpc.pb.h"
#include "axisgate/v1/stage.grpc.pb.h"
#include "server/rpc/device_service.h"
#include "server/rpc/stage_service.h"

namespace axisgate::rpc {

// A service of which some methods are served, the rest left to the server's generic service.
template <class Service>
class Partly : public Service {
 protected:
  Partly(std::string_view name, const google::protobuf::FileDescriptor& file,
         std::initializer_list<std::string_view> served) {
    const google::protobuf::ServiceDescriptor& service = *file.FindServiceByName(std::string(name));
    for (int i = 0; i < service.method_count(); ++i) {
      if (std::find(served.begin(), served.end(), service.method(i)->name()) == served.end()) {
        this->MarkMethodGeneric(i);
      }
    }
  }
};

class StopService final : public Partly<v1::StageService::WithCallbackMethod_Stop<
                              v1::StageService::WithCallbackMethod_EmergencyStop<v1::StageService::Service>>> {
 public:
  // `stage` outlives this.
  explicit StopService(StageService& stage)
      : Partly("StageService", *v1::StopRequest::descriptor()->file(), {"Stop", "EmergencyStop"}), stage_(stage) {}

  grpc::ServerUnaryReactor* Stop(grpc::CallbackServerContext* context, const v1::StopRequest* request,
                                 v1::StopResponse* response) override {
    return stage_.Stop(context, request, response);
  }
  grpc::ServerUnaryReactor* EmergencyStop(grpc::CallbackServerContext* context, const v1::EmergencyStopRequest* request,
                                          v1::EmergencyStopResponse* response) override {
    return stage_.EmergencyStop(context, request, response);
  }

 private:
  StageService& stage_;
};

// A stop names its device: a caller that does not know the name asks here. It is answered from memory.
class NamesService final
    : public Partly<v1::DeviceService::WithCallbackMethod_ListDevices<v1::DeviceService::Service>> {
 public:
  // `devices` outlives this.
  explicit NamesService(DeviceService& devices)
      : Partly("DeviceService", *v1::ListDevicesRequest::descriptor()->file(), {"ListDevices"}), devices_(devices) {}

  grpc::ServerUnaryReactor* ListDevices(grpc::CallbackServerContext* context, const v1::ListDevicesRequest* request,
                                        v1::ListDevicesResponse* response) override {
    return devices_.ListDevices(context, request, response);
  }

 private:
  DeviceService& devices_;
};

// Answers every call of any service with queue_full and what to do about it.
class RefusingService final : public grpc::CallbackGenericService {
 public:
  grpc::ServerGenericBidiReactor* CreateReactor(grpc::GenericCallbackServerContext* context) override;
};

}  // namespace axisgate::rpc
