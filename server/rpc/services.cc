#include "server/rpc/services.h"

#include <google/protobuf/descriptor.h>

#include <array>

namespace axisgate::rpc {
namespace {

constexpr std::array kServices = {
    ServedService{"axisgate.v1.DeviceService", device_service},
    ServedService{"axisgate.v1.StageService", stage_service},
    ServedService{"axisgate.v1.EventService", event_service},
    ServedService{"axisgate.v1.HistoryService", history_service},
    ServedService{"axisgate.v1.CommandService", command_service},
    ServedService{"axisgate.v1.DiagnosticsService", diagnostics_service},
    ServedService{"axisgate.v1.ControlService", control_service},
    ServedService{"axisgate.v1.AccessService", access_service},
    ServedService{"axisgate.v1.SettingService", setting_service},
    ServedService{"axisgate.v1.SimulatorService", simulator_service},
    ServedService{"axisgate.v1.PositionService", position_service},
    ServedService{"axisgate.v1.MillService", mill_service},
    ServedService{"grpc.health.v1.Health", health_service},
    ServedService{"grpc.reflection.v1alpha.ServerReflection"},
};

}  // namespace

std::span<const ServedService> services() { return kServices; }

bool is_of_api(std::string_view service) { return service.starts_with("axisgate.v1."); }

std::vector<ServedMethod> served_methods() {
  std::vector<ServedMethod> methods;
  for (const ServedService& service : services()) {
    const google::protobuf::ServiceDescriptor& descriptor =
        *google::protobuf::DescriptorPool::generated_pool()->FindServiceByName(std::string(service.name));
    for (int i = 0; i < descriptor.method_count(); ++i) {
      const google::protobuf::MethodDescriptor& method = *descriptor.method(i);
      const bool streams = method.client_streaming() || method.server_streaming();
      methods.push_back({descriptor.full_name() + "/" + method.name(), streams});
    }
  }
  return methods;
}

}  // namespace axisgate::rpc
