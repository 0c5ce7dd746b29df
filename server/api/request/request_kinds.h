// All kinds of requests and their rules, in one table for admission, pipeline, streams and audit. README.md has the
// same table for people.
#pragma once

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
  scan,
  jog,
  stop,
  emergency_stop,
  get_motion,
  list_motions,
  watch_motion,
  cancel_motion,
  send_job,
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
  std::string_view name;  // "change settings", for people; never changed, because the journal has it
  server::Role least_role;
  server::AdminKey admin_key;  // key in `admin_commands` of the configuration that restricts the request to
                               // administrators
  Quota quota;
  DeadlineRule deadline;
  Use use;
  bool audited;  // the log says who requested it
};

const Rule& rule_of(RequestKind kind);
bool uses_axes(RequestKind kind);

std::string_view name(RequestKind kind);

}  // namespace axisgate::api
