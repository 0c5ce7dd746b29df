#include "server/journal/entry.h"

#include <fmt/format.h>

namespace axisgate::server::journal {

std::string name(EntryKind kind) {
  switch (kind) {
    case EntryKind::daemon_started:
      return "daemon started";
    case EntryKind::daemon_ended:
      return "daemon ended";
    case EntryKind::entries_left_out:
      return "entries left out";
    case EntryKind::journal_failed:
      return "journal failed";
    case EntryKind::entries_dropped:
      return "entries dropped";
    case EntryKind::motion_requested:
      return "motion requested";
    case EntryKind::motion_started:
      return "motion started";
    case EntryKind::motion_ended:
      return "motion ended";
    case EntryKind::stop_requested:
      return "stop requested";
    case EntryKind::stop_ended:
      return "stop ended";
    case EntryKind::emergency_latched:
      return "emergency stop latched";
    case EntryKind::emergency_cleared:
      return "emergency stop cleared";
    case EntryKind::link_changed:
      return "link changed";
    case EntryKind::barrier_entered:
      return "barrier entered";
    case EntryKind::foreign_motion:
      return "foreign motion";
    case EntryKind::condition_changed:
      return "condition changed";
    case EntryKind::switches_changed:
      return "switches changed";
    case EntryKind::request_made:
      return "request made";
    case EntryKind::request_refused:
      return "request refused";
    case EntryKind::request_ended:
      return "request ended";
    case EntryKind::lines_exchanged:
      return "lines exchanged";
    case EntryKind::lease_granted:
      return "lease granted";
    case EntryKind::lease_ended:
      return "lease ended";
    case EntryKind::latched:
      return "latched";
    case EntryKind::rearmed:
      return "rearmed";
    case EntryKind::person_erased:
      return "person erased";
    case EntryKind::job_changed:
      return "job";
  }
  return fmt::format("kind {}", static_cast<int>(kind));
}

}  // namespace axisgate::server::journal
