// Names of the services and methods that the daemon serves.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate::rpc {

inline constexpr std::array<std::string_view, 12> kApiServices = {
    "axisgate.v1.DeviceService",    "axisgate.v1.StageService",    "axisgate.v1.EventService",
    "axisgate.v1.HistoryService",   "axisgate.v1.CommandService",  "axisgate.v1.DiagnosticsService",
    "axisgate.v1.ControlService",   "axisgate.v1.AccessService",   "axisgate.v1.SettingService",
    "axisgate.v1.SimulatorService", "axisgate.v1.PositionService", "axisgate.v1.MillService"};

// gRPC's own services.
inline constexpr std::array<std::string_view, 2> kCommonServices = {"grpc.health.v1.Health",
                                                                    "grpc.reflection.v1alpha.ServerReflection"};

struct ServedMethod {
  std::string name;  // "axisgate.v1.StageService/Move"
  bool streams = false;
};
// Methods of all these services.
std::vector<ServedMethod> served_methods();

}  // namespace axisgate::rpc
