#include "server/rpc/gate/method_kinds.h"

#include <algorithm>
#include <array>
#include <utility>

namespace axisgate::rpc {
namespace {

using Kind = api::RequestKind;
using MethodKind = std::pair<std::string_view, Kind>;

constexpr std::string_view kApi = "/axisgate.v1.";

constexpr std::array<MethodKind, 62> kKinds = {{
    {"AccessService/GetCaller", Kind::get_caller},
    {"AccessService/CreateToken", Kind::create_token},
    {"AccessService/ListTokens", Kind::list_tokens},
    {"AccessService/RevokeToken", Kind::revoke_token},
    {"CommandService/ListCommands", Kind::list_commands},
    {"CommandService/Execute", Kind::execute},
    {"ControlService/AcquireLease", Kind::acquire_lease},
    {"ControlService/KeepLeaseAlive", Kind::keep_lease_alive},
    {"ControlService/ReleaseLease", Kind::release_lease},
    {"ControlService/HandOverLease", Kind::hand_over_lease},
    {"ControlService/TakeOverLease", Kind::take_over_lease},
    {"ControlService/WatchLeases", Kind::watch_leases},
    {"ControlService/Rearm", Kind::rearm},
    {"DeviceService/ListDevices", Kind::list_devices},
    {"DeviceService/GetDevice", Kind::get_device},
    {"DeviceService/WatchDevice", Kind::watch_device},
    {"DeviceService/ClearErrors", Kind::clear_errors},
    {"DeviceService/WithdrawStop", Kind::withdraw_stop},
    {"DiagnosticsService/Record", Kind::record},
    {"DiagnosticsService/GetSupportReport", Kind::get_support_report},
    {"EventService/Watch", Kind::watch_events},
    {"HistoryService/ListHistory", Kind::list_history},
    {"HistoryService/SummarizeHistory", Kind::summarize_history},
    {"HistoryService/VerifyJournal", Kind::verify_journal},
    {"HistoryService/ErasePerson", Kind::erase_person},
    {"MillService/SendJob", Kind::send_job},
    {"MillService/RepeatJob", Kind::repeat_job},
    {"MillService/GetMill", Kind::get_mill},
    {"MillService/WatchMill", Kind::watch_mill},
    {"MillService/ConfirmJob", Kind::confirm_job},
    {"MillService/StartJob", Kind::start_job},
    {"MillService/PauseJob", Kind::pause_job},
    {"MillService/ResumeJob", Kind::resume_job},
    {"MillService/ContinueJob", Kind::continue_job},
    {"MillService/AbortJob", Kind::abort_job},
    {"MillService/CancelJob", Kind::cancel_job},
    {"MillService/CancelJobs", Kind::cancel_jobs},
    {"MillService/MoveJob", Kind::move_job},
    {"MillService/ReportJobDone", Kind::report_job_done},
    {"MillService/OperateMill", Kind::operate_mill},
    {"PositionService/SavePosition", Kind::save_position},
    {"PositionService/ListPositions", Kind::list_positions},
    {"PositionService/DeletePosition", Kind::delete_position},
    {"PositionService/MoveToPosition", Kind::move_to_position},
    {"SettingService/GetSettings", Kind::get_settings},
    {"SettingService/ChangeSettings", Kind::change_settings},
    {"SettingService/SetCoordinates", Kind::set_coordinates},
    {"SettingService/FireTrigger", Kind::fire_trigger},
    {"SettingService/ResetDevice", Kind::reset_device},
    {"SimulatorService/Operate", Kind::operate_simulator},
    {"StageService/Move", Kind::move},
    {"StageService/Home", Kind::home},
    {"StageService/ReturnToOrigin", Kind::return_to_origin},
    {"StageService/RunPath", Kind::run_path},
    {"StageService/Scan", Kind::scan},
    {"StageService/Jog", Kind::jog},
    {"StageService/Stop", Kind::stop},
    {"StageService/EmergencyStop", Kind::emergency_stop},
    {"StageService/GetMotion", Kind::get_motion},
    {"StageService/ListMotions", Kind::list_motions},
    {"StageService/WatchMotion", Kind::watch_motion},
    {"StageService/CancelMotion", Kind::cancel_motion},
}};

constexpr std::string_view kReflection = "/grpc.reflection.v1.ServerReflection/",
                           kReflectionServed = "/grpc.reflection.v1alpha.ServerReflection/";

// gRPC's own services, by the beginning of the method. All of their methods only read.
constexpr std::array<MethodKind, 6> kOfGrpc = {{
    {"/grpc.health.v1.Health/Watch", Kind::watch_server},
    {"/grpc.reflection.v1.ServerReflection/ServerReflectionInfo", Kind::watch_server},
    {"/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo", Kind::watch_server},
    {"/grpc.health.v1.Health/", Kind::ask_server},
    {kReflection, Kind::ask_server},
    {kReflectionServed, Kind::ask_server},
}};

}  // namespace

Kind kind_of(std::string_view method) {
  const auto begins = [method](const MethodKind& entry) { return method.starts_with(entry.first); };
  if (!method.starts_with(kApi)) {
    const auto found = std::ranges::find_if(kOfGrpc, begins);
    return found == kOfGrpc.end() ? Kind::unlisted : found->second;
  }
  method.remove_prefix(kApi.size());
  const auto found = std::ranges::find(kKinds, method, &MethodKind::first);
  return found == kKinds.end() ? Kind::unlisted : found->second;
}

std::string served_as(std::string_view method) {
  if (!method.starts_with(kReflection)) return std::string(method);
  return std::string(kReflectionServed).append(method.substr(kReflection.size()));
}

}  // namespace axisgate::rpc
