// The names of what is served.
#pragma once

#include <array>
#include <string_view>

namespace axisgate::rpc {

inline constexpr std::array<std::string_view, 7> kApiServices = {
    "axisgate.v1.DeviceService",  "axisgate.v1.StageService",       "axisgate.v1.EventService",
    "axisgate.v1.CommandService", "axisgate.v1.DiagnosticsService", "axisgate.v1.ControlService",
    "axisgate.v1.AccessService"};

// Those of gRPC itself.
inline constexpr std::array<std::string_view, 2> kCommonServices = {"grpc.health.v1.Health",
                                                                    "grpc.reflection.v1alpha.ServerReflection"};

}  // namespace axisgate::rpc
