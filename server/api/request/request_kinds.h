// Every kind of request, and the rules for it: one table, which admission, pipeline, streams and audit read. The same
// table for people stands in README.md.
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
  ask_door,    // what a door says of itself in one answer: its health
  watch_door,  // the same as a stream
  unlisted,    // no kind that this table knows
};
inline constexpr std::size_t kRequestKinds = static_cast<std::size_t>(RequestKind::unlisted) + 1;

// What the request takes of what its caller may have open at once.
enum class Quota {
  none,     // neither counted nor refused: what a stop needs
  request,  // one answer
  stream,
  outcome,  // a stream that follows one motion: some are kept for these
  path,     // a stream that holds a whole path in memory
};

// What of the call's context counts, and for how long the request does.
enum class Patience {
  stop,      // as question; the lease counts, and no context refuses it
  question,  // until the call's deadline, or for 20 s
  change,    // until not_after; without one until the call's deadline, or for 20 s
  motion,    // until not_after, or for 5 s; the call's deadline ends it earlier
};

// What the request does with a device's axes.
enum class Use {
  nothing,
  lease,     // the caller's own lease, without the right to the axes
  axes,      // the device asks for the right to them: lease, latch and epochs, as it begins and with each line
  all_axes,  // likewise; the pipeline asks for all axes first, since the device may not be asked at all
};

struct Rule {
  RequestKind kind;
  std::string_view name;  // "change settings", for people; also in the journal, so that it stays
  server::Role least_role;
  server::KeptRequest kept;  // under which `admin_commands` of the configuration may keep it for administrators
  Quota quota;
  Patience patience;
  Use use;
  bool audited;  // the log says who did it
};

const Rule& rule_of(RequestKind kind);
bool uses_axes(RequestKind kind);

std::string_view name(RequestKind kind);

}  // namespace axisgate::api
