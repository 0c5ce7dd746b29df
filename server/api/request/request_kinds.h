// All kinds of requests and their rules, in one table for the doors, admission, pipeline, streams and audit. The README
// of server/api explains the columns.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "server/access/access.h"

namespace axisgate::api {

enum class RequestKind {
  get_caller,
  create_token,
  list_tokens,
  revoke_token,
  list_commands,
  execute,
  acquire_lease,
  keep_lease_alive,
  renew_lease,
  release_lease,
  hand_over_lease,
  take_over_lease,
  watch_leases,
  rearm,
  list_devices,
  get_device,
  watch_device,
  clear_errors,
  withdraw_stop,
  record,
  get_support_report,
  watch_events,
  list_history,
  summarize_history,
  verify_journal,
  erase_person,
  save_position,
  list_positions,
  delete_position,
  move_to_position,
  get_settings,
  change_settings,
  set_coordinates,
  fire_trigger,
  reset_device,
  operate_simulator,
  move,
  home,
  return_to_origin,
  run_path,
  start_path,
  scan,
  jog,
  start_jog,
  keep_jog,
  stop_jog,
  stop,
  emergency_stop,
  get_motion,
  list_motions,
  watch_motion,
  wait_motion,
  cancel_motion,
  send_job,
  send_job_piece,
  repeat_job,
  get_mill,
  watch_mill,
  confirm_job,
  start_job,
  pause_job,
  resume_job,
  continue_job,
  abort_job,
  cancel_job,
  cancel_jobs,
  move_job,
  report_job_done,
  operate_mill,
  ask_server,    // question about the server itself with one answer: its health
  watch_server,  // the same as a stream
  unlisted,      // not in this table
};
inline constexpr std::size_t kRequestKinds = static_cast<std::size_t>(RequestKind::unlisted) + 1;

// Count that a request takes from its caller's limit of open requests and streams.
enum class Quota {
  none,     // neither counted nor refused, as stops require
  request,  // request with one answer
  stream,
  motion_stream,  // a stream that follows one motion; some places are reserved for these
  path,           // a stream that keeps a whole path in memory
};

// Time for which a request counts, and the parts of the call's context that apply to it.
enum class DeadlineRule {
  stop,      // as question; the lease applies, and no context refuses it
  question,  // until the call's deadline, or for 20 s
  change,    // until not_after; without it until the call's deadline, or for 20 s
  motion,    // until not_after, or for 5 s; the call's deadline ends it earlier
};

// Use that a request makes of a device's axes.
enum class Use {
  nothing,
  lease,     // the caller's own lease, but not the right to the axes
  axes,      // the device checks the right (lease, latch, epochs) when the request begins, and with each line
  all_axes,  // as axes; the pipeline checks all axes first, because the device may not be asked at all
};

struct Rule {
  RequestKind kind;
  std::string_view method;  // "StageService/Move", in the package axisgate.v1; empty: not of this API
  std::string_view name;    // "change settings", for people; the journal stores it, so it never changes
  server::Role least_role;
  server::AdminKey admin_key;  // key in `admin_commands` of the configuration that restricts the request to
                               // administrators
  Quota quota;
  DeadlineRule deadline;
  Use use;
  bool audited;  // the log says who requested it
};

// The rules. The same rules are typed by hand in tests/api/matrix_test.cc.
// clang-format off
inline constexpr std::array<Rule, kRequestKinds> kRules = {{
    // kind                           method                                 name                  least role               admin key                       quota                 deadline                use            audited
    {RequestKind::get_caller,         "AccessService/GetCaller",             "get caller",         server::Role::observer,  server::AdminKey::none,         Quota::request,       DeadlineRule::question, Use::nothing,  false},
    {RequestKind::create_token,       "AccessService/CreateToken",           "create token",       server::Role::admin,     server::AdminKey::none,         Quota::request,       DeadlineRule::question, Use::nothing,  true},
    {RequestKind::list_tokens,        "AccessService/ListTokens",            "list tokens",        server::Role::admin,     server::AdminKey::none,         Quota::request,       DeadlineRule::question, Use::nothing,  false},
    {RequestKind::revoke_token,       "AccessService/RevokeToken",           "revoke token",       server::Role::admin,     server::AdminKey::none,         Quota::request,       DeadlineRule::question, Use::nothing,  true},
    {RequestKind::list_commands,      "CommandService/ListCommands",         "list commands",      server::Role::observer,  server::AdminKey::none,         Quota::request,       DeadlineRule::question, Use::nothing,  false},
    {RequestKind::execute,            "CommandService/Execute",              "execute",            server::Role::operator_, server::AdminKey::none,         Quota::stream,        DeadlineRule::change,   Use::axes,     true},
    {RequestKind::acquire_lease,      "ControlService/AcquireLease",         "acquire lease",      server::Role::operator_, server::AdminKey::none,         Quota::request,       DeadlineRule::change,   Use::nothing,  false},
    {RequestKind::keep_lease_alive,   "ControlService/KeepLeaseAlive",       "keep lease alive",   server::Role::operator_, server::AdminKey::none,         Quota::stream,        DeadlineRule::question, Use::nothing,  false},
    {RequestKind::renew_lease,        "ControlService/RenewLease",           "renew lease",        server::Role::operator_, server::AdminKey::none,         Quota::request,       DeadlineRule::question, Use::lease,    false},
    {RequestKind::release_lease,      "ControlService/ReleaseLease",         "release lease",      server::Role::operator_, server::AdminKey::none,         Quota::request,       DeadlineRule::question, Use::lease,    false},
    {RequestKind::hand_over_lease,    "ControlService/HandOverLease",        "hand over lease",    server::Role::operator_, server::AdminKey::none,         Quota::request,       DeadlineRule::question, Use::lease,    false},
    {RequestKind::take_over_lease,    "ControlService/TakeOverLease",        "take over lease",    server::Role::operator_, server::AdminKey::take_over,    Quota::request,       DeadlineRule::change,   Use::nothing,  false},
    {RequestKind::watch_leases,       "ControlService/WatchLeases",          "watch leases",       server::Role::observer,  server::AdminKey::none,         Quota::stream,        DeadlineRule::question, Use::nothing,  false},
    {RequestKind::rearm,              "ControlService/Rearm",                "rearm",              server::Role::operator_, server::AdminKey::none,         Quota::request,       DeadlineRule::change,   Use::lease,    false},
    {RequestKind::list_devices,       "DeviceService/ListDevices",           "list devices",       server::Role::observer,  server::AdminKey::none,         Quota::none,          DeadlineRule::question, Use::nothing,  false},
    {RequestKind::get_device,         "DeviceService/GetDevice",             "get device",         server::Role::observer,  server::AdminKey::none,         Quota::request,       DeadlineRule::question, Use::nothing,  false},
    {RequestKind::watch_device,       "DeviceService/WatchDevice",           "watch device",       server::Role::observer,  server::AdminKey::none,         Quota::stream,        DeadlineRule::question, Use::nothing,  false},
    {RequestKind::clear_errors,       "DeviceService/ClearErrors",           "clear errors",       server::Role::operator_, server::AdminKey::clear_errors, Quota::request,       DeadlineRule::change,   Use::axes,     true},
    {RequestKind::withdraw_stop,      "DeviceService/WithdrawStop",          "withdraw stop",      server::Role::admin,     server::AdminKey::none,         Quota::request,       DeadlineRule::change,   Use::nothing,  true},
    {RequestKind::record,             "DiagnosticsService/Record",           "record",             server::Role::observer,  server::AdminKey::none,         Quota::stream,        DeadlineRule::question, Use::nothing,  false},
    {RequestKind::get_support_report, "DiagnosticsService/GetSupportReport", "get support report", server::Role::observer,  server::AdminKey::none,         Quota::stream,        DeadlineRule::question, Use::nothing,  false},
    {RequestKind::watch_events,       "EventService/Watch",                  "watch events",       server::Role::observer,  server::AdminKey::none,         Quota::stream,        DeadlineRule::question, Use::nothing,  false},
    {RequestKind::list_history,       "HistoryService/ListHistory",          "list history",       server::Role::observer,  server::AdminKey::none,         Quota::request,       DeadlineRule::question, Use::nothing,  false},
    {RequestKind::summarize_history,  "HistoryService/SummarizeHistory",     "summarize history",  server::Role::observer,  server::AdminKey::none,         Quota::request,       DeadlineRule::question, Use::nothing,  false},
    {RequestKind::verify_journal,     "HistoryService/VerifyJournal",        "verify journal",     server::Role::observer,  server::AdminKey::none,         Quota::request,       DeadlineRule::question, Use::nothing,  false},
    {RequestKind::erase_person,       "HistoryService/ErasePerson",          "erase person",       server::Role::admin,     server::AdminKey::none,         Quota::request,       DeadlineRule::question, Use::nothing,  true},
    {RequestKind::save_position,      "PositionService/SavePosition",        "save position",      server::Role::operator_, server::AdminKey::none,         Quota::request,       DeadlineRule::change,   Use::axes,     true},
    {RequestKind::list_positions,     "PositionService/ListPositions",       "list positions",     server::Role::observer,  server::AdminKey::none,         Quota::request,       DeadlineRule::question, Use::nothing,  false},
    {RequestKind::delete_position,    "PositionService/DeletePosition",      "delete position",    server::Role::operator_, server::AdminKey::none,         Quota::request,       DeadlineRule::change,   Use::all_axes, true},
    {RequestKind::move_to_position,   "PositionService/MoveToPosition",      "move to position",   server::Role::operator_, server::AdminKey::none,         Quota::request,       DeadlineRule::motion,   Use::axes,     true},
    {RequestKind::get_settings,       "SettingService/GetSettings",          "get settings",       server::Role::observer,  server::AdminKey::none,         Quota::request,       DeadlineRule::question, Use::nothing,  false},
    {RequestKind::change_settings,    "SettingService/ChangeSettings",       "change settings",    server::Role::operator_, server::AdminKey::none,         Quota::request,       DeadlineRule::change,   Use::axes,     true},
    {RequestKind::set_coordinates,    "SettingService/SetCoordinates",       "set coordinates",    server::Role::operator_, server::AdminKey::none,         Quota::request,       DeadlineRule::change,   Use::axes,     true},
    {RequestKind::fire_trigger,       "SettingService/FireTrigger",          "fire trigger",       server::Role::operator_, server::AdminKey::none,         Quota::request,       DeadlineRule::change,   Use::axes,     true},
    {RequestKind::reset_device,       "SettingService/ResetDevice",          "reset device",       server::Role::operator_, server::AdminKey::reset_device, Quota::request,       DeadlineRule::change,   Use::axes,     true},
    {RequestKind::operate_simulator,  "SimulatorService/Operate",            "operate simulator",  server::Role::operator_, server::AdminKey::none,         Quota::request,       DeadlineRule::question, Use::nothing,  false},
    {RequestKind::move,               "StageService/Move",                   "move",               server::Role::operator_, server::AdminKey::none,         Quota::request,       DeadlineRule::motion,   Use::axes,     true},
    {RequestKind::home,               "StageService/Home",                   "home",               server::Role::operator_, server::AdminKey::none,         Quota::request,       DeadlineRule::motion,   Use::axes,     true},
    {RequestKind::return_to_origin,   "StageService/ReturnToOrigin",         "return to origin",   server::Role::operator_, server::AdminKey::none,         Quota::request,       DeadlineRule::motion,   Use::axes,     true},
    {RequestKind::run_path,           "StageService/RunPath",                "run path",           server::Role::operator_, server::AdminKey::none,         Quota::path,          DeadlineRule::motion,   Use::axes,     true},
    {RequestKind::start_path,         "StageService/StartPath",              "start path",         server::Role::operator_, server::AdminKey::none,         Quota::path,          DeadlineRule::motion,   Use::axes,     true},
    {RequestKind::scan,               "StageService/Scan",                   "scan",               server::Role::operator_, server::AdminKey::none,         Quota::request,       DeadlineRule::motion,   Use::axes,     true},
    {RequestKind::jog,                "StageService/Jog",                    "jog",                server::Role::operator_, server::AdminKey::none,         Quota::stream,        DeadlineRule::motion,   Use::axes,     true},
    {RequestKind::start_jog,          "StageService/StartJog",               "start jog",          server::Role::operator_, server::AdminKey::none,         Quota::stream,        DeadlineRule::motion,   Use::axes,     true},
    {RequestKind::keep_jog,           "StageService/KeepJog",                "keep jog",           server::Role::operator_, server::AdminKey::none,         Quota::request,       DeadlineRule::question, Use::nothing,  false},
    {RequestKind::stop_jog,           "StageService/StopJog",                "stop jog",           server::Role::operator_, server::AdminKey::none,         Quota::request,       DeadlineRule::question, Use::nothing,  false},
    {RequestKind::stop,               "StageService/Stop",                   "stop",               server::Role::observer,  server::AdminKey::none,         Quota::none,          DeadlineRule::stop,     Use::nothing,  false},
    {RequestKind::emergency_stop,     "StageService/EmergencyStop",          "emergency stop",     server::Role::observer,  server::AdminKey::none,         Quota::none,          DeadlineRule::stop,     Use::nothing,  false},
    {RequestKind::get_motion,         "StageService/GetMotion",              "get motion",         server::Role::observer,  server::AdminKey::none,         Quota::request,       DeadlineRule::question, Use::nothing,  false},
    {RequestKind::list_motions,       "StageService/ListMotions",            "list motions",       server::Role::observer,  server::AdminKey::none,         Quota::request,       DeadlineRule::question, Use::nothing,  false},
    {RequestKind::watch_motion,       "StageService/WatchMotion",            "watch motion",       server::Role::observer,  server::AdminKey::none,         Quota::motion_stream, DeadlineRule::question, Use::nothing,  false},
    {RequestKind::wait_motion,        "StageService/WaitMotion",             "wait motion",        server::Role::observer,  server::AdminKey::none,         Quota::motion_stream, DeadlineRule::question, Use::nothing,  false},
    {RequestKind::cancel_motion,      "StageService/CancelMotion",           "cancel motion",      server::Role::operator_, server::AdminKey::none,         Quota::request,       DeadlineRule::stop,     Use::nothing,  false},
    {RequestKind::send_job,           "MillService/SendJob",                 "send job",           server::Role::operator_, server::AdminKey::none,         Quota::stream,        DeadlineRule::change,   Use::nothing,  true},
    {RequestKind::send_job_piece,     "MillService/SendJobPiece",            "send job piece",     server::Role::operator_, server::AdminKey::none,         Quota::request,       DeadlineRule::change,   Use::nothing,  false},
    {RequestKind::repeat_job,         "MillService/RepeatJob",               "repeat job",         server::Role::operator_, server::AdminKey::none,         Quota::request,       DeadlineRule::change,   Use::nothing,  true},
    {RequestKind::get_mill,           "MillService/GetMill",                 "get mill",           server::Role::observer,  server::AdminKey::none,         Quota::request,       DeadlineRule::question, Use::nothing,  false},
    {RequestKind::watch_mill,         "MillService/WatchMill",               "watch mill",         server::Role::observer,  server::AdminKey::none,         Quota::stream,        DeadlineRule::question, Use::nothing,  false},
    {RequestKind::confirm_job,        "MillService/ConfirmJob",              "confirm job",        server::Role::operator_, server::AdminKey::none,         Quota::request,       DeadlineRule::change,   Use::nothing,  true},
    {RequestKind::start_job,          "MillService/StartJob",                "start job",          server::Role::operator_, server::AdminKey::none,         Quota::request,       DeadlineRule::change,   Use::axes,     true},
    {RequestKind::pause_job,          "MillService/PauseJob",                "pause job",          server::Role::operator_, server::AdminKey::none,         Quota::request,       DeadlineRule::change,   Use::nothing,  true},
    {RequestKind::resume_job,         "MillService/ResumeJob",               "resume job",         server::Role::operator_, server::AdminKey::none,         Quota::request,       DeadlineRule::change,   Use::axes,     true},
    {RequestKind::continue_job,       "MillService/ContinueJob",             "continue job",       server::Role::operator_, server::AdminKey::none,         Quota::request,       DeadlineRule::change,   Use::nothing,  true},
    {RequestKind::abort_job,          "MillService/AbortJob",                "abort job",          server::Role::observer,  server::AdminKey::none,         Quota::none,          DeadlineRule::stop,     Use::nothing,  true},
    {RequestKind::cancel_job,         "MillService/CancelJob",               "cancel job",         server::Role::operator_, server::AdminKey::none,         Quota::request,       DeadlineRule::change,   Use::nothing,  true},
    {RequestKind::cancel_jobs,        "MillService/CancelJobs",              "cancel jobs",        server::Role::admin,     server::AdminKey::none,         Quota::request,       DeadlineRule::change,   Use::nothing,  true},
    {RequestKind::move_job,           "MillService/MoveJob",                 "move job",           server::Role::operator_, server::AdminKey::none,         Quota::request,       DeadlineRule::change,   Use::nothing,  true},
    {RequestKind::report_job_done,    "MillService/ReportJobDone",           "report job done",    server::Role::operator_, server::AdminKey::none,         Quota::request,       DeadlineRule::change,   Use::nothing,  true},
    {RequestKind::operate_mill,       "MillService/OperateMill",             "operate mill",       server::Role::operator_, server::AdminKey::none,         Quota::request,       DeadlineRule::change,   Use::axes,     true},
    {RequestKind::ask_server,         "",                                    "ask server",         server::Role::observer,  server::AdminKey::none,         Quota::request,       DeadlineRule::question, Use::nothing,  false},
    {RequestKind::watch_server,       "",                                    "watch server",       server::Role::observer,  server::AdminKey::none,         Quota::stream,        DeadlineRule::question, Use::nothing,  false},
    {RequestKind::unlisted,           "",                                    "unlisted",           server::Role::admin,     server::AdminKey::none,         Quota::request,       DeadlineRule::question, Use::nothing,  false},
}};
// clang-format on

// rule_of() uses the kind's number as the index of its row.
static_assert([] {
  for (std::size_t i = 0; i < kRules.size(); ++i) {
    if (kRules[i].kind != static_cast<RequestKind>(i)) return false;
  }
  return true;
}());

const Rule& rule_of(RequestKind kind);
// Returns the kind of a method of this API, e.g. "StageService/Move"; unlisted for an unknown method.
RequestKind kind_of(std::string_view method);
bool uses_axes(RequestKind kind);

std::string_view name(RequestKind kind);

}  // namespace axisgate::api
