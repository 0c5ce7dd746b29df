#include "server/rpc/method_roles.h"

#include <algorithm>
#include <array>
#include <utility>

namespace axisgate::rpc {
namespace {

using server::Role;

constexpr std::string_view kApi = "/axisgate.v1.";

// Health and reflection are gRPC's own.
constexpr std::array<std::string_view, 2> kReadOnlyServices = {"/grpc.health.v1.Health/",
                                                               "/grpc.reflection.v1alpha.ServerReflection/"};

constexpr std::array<std::pair<std::string_view, Role>, 39> kRoles = {{
    {"AccessService/GetCaller", Role::observer},
    {"CommandService/ListCommands", Role::observer},
    {"CommandService/Execute", Role::operator_},
    {"ControlService/AcquireLease", Role::operator_},
    {"ControlService/KeepLeaseAlive", Role::operator_},
    {"ControlService/ReleaseLease", Role::operator_},
    {"ControlService/HandOverLease", Role::operator_},
    {"ControlService/WatchLeases", Role::observer},
    {"ControlService/Rearm", Role::operator_},
    {"DeviceService/ListDevices", Role::observer},
    {"DeviceService/GetDevice", Role::observer},
    {"DeviceService/WatchDevice", Role::observer},
    {"DeviceService/ClearErrors", Role::operator_},
    {"DiagnosticsService/Record", Role::observer},
    {"DiagnosticsService/GetSupportReport", Role::observer},
    {"EventService/Watch", Role::observer},
    {"PositionService/SavePosition", Role::operator_},
    {"PositionService/ListPositions", Role::observer},
    {"PositionService/DeletePosition", Role::operator_},
    {"PositionService/MoveToPosition", Role::operator_},
    {"SettingService/GetSettings", Role::observer},
    {"SettingService/ChangeSettings", Role::operator_},
    {"SettingService/SetCoordinates", Role::operator_},
    {"SettingService/FireTrigger", Role::operator_},
    {"SettingService/ResetDevice", Role::operator_},
    {"SimulatorService/Operate", Role::operator_},
    {"StageService/Move", Role::operator_},
    {"StageService/Home", Role::operator_},
    {"StageService/ReturnToOrigin", Role::operator_},
    {"StageService/RunPath", Role::operator_},
    {"StageService/Scan", Role::operator_},
    {"StageService/Jog", Role::operator_},
    {"StageService/Stop", Role::observer},
    {"StageService/EmergencyStop", Role::observer},
    {"StageService/GetMotion", Role::observer},
    {"StageService/ListMotions", Role::observer},
    {"StageService/WatchMotion", Role::observer},
    {"StageService/CancelMotion", Role::operator_},
    {"ControlService/TakeOverLease", Role::operator_},
}};

// Methods that are nothing but one of the things that the configuration may keep for administrators.
constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kSpecial = {{
    {"DeviceService/ClearErrors", "BEC:"},
    {"ControlService/TakeOverLease", "take-over"},
    {"SettingService/ResetDevice", "RESET:"},
}};

}  // namespace

Role role_for(std::string_view method, const server::Access& access) {
  const auto read_only = [method](std::string_view service) { return method.starts_with(service); };
  if (std::ranges::any_of(kReadOnlyServices, read_only)) return Role::observer;
  if (!method.starts_with(kApi)) return Role::admin;
  method.remove_prefix(kApi.size());
  const auto is_method = [method](const auto& entry) { return entry.first == method; };
  const auto special = std::ranges::find_if(kSpecial, is_method);
  if (special != kSpecial.end() && access.only_for_admins(special->second)) return Role::admin;
  const auto found = std::ranges::find_if(kRoles, is_method);
  return found == kRoles.end() ? Role::admin : found->second;
}

}  // namespace axisgate::rpc
