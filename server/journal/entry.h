// One entry of the journal.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "device/core/time.h"
#include "server/events/wall_time.h"

namespace axisgate::server::journal {

// The numbers are in the file and never change.
enum class EntryKind {
  daemon_started = 1,
  daemon_ended = 2,
  entries_left_out = 3,
  journal_failed = 4,   // the disk has refused entries from the first failure until this entry
  entries_dropped = 5,  // old entries were dropped, by age or size, up to a number
  motion_requested = 10,
  motion_started = 11,
  motion_ended = 12,
  stop_requested = 20,
  stop_ended = 21,         // was confirmed or withdrawn
  emergency_latched = 22,  // motion is refused until emergency_cleared
  emergency_cleared = 23,
  link_changed = 30,
  barrier_entered = 31,
  foreign_motion = 32,
  condition_changed = 33,  // an emergency stop, a limit sensor, a motor or the mode, at the stage itself
  switches_changed = 40,
  request_made = 50,     // a caller's wish to change or move something; on the disk before it is carried out
  request_refused = 51,  // nothing was sent
  request_ended = 52,    // end of a request that is not a motion
  lines_exchanged = 60,  // lines without a motion, or lines that do not fit into its start and end
  lease_granted = 70,
  lease_ended = 71,
  latched = 72,  // the caller, by another caller's stop
  rearmed = 73,
  person_erased = 80,  // the name of a caller
  job_changed = 90,    // a mill's job was queued, changed its state or was moved in the queue
};
// Returns a name such as "motion ended", or "kind 77" for a number that this program does not know.
std::string name(EntryKind kind);

struct Entry {
  EntryKind kind = EntryKind::daemon_started;
  WallTime time{};
  TimePoint boot_time{};     // since the machine's boot; setting the calendar clock does not affect it
  std::string device{};      // empty: the daemon itself
  std::string who{};         // the caller; empty: none
  std::uint64_t motion = 0;  // number of the motion; 0: none
  std::string body{};        // JSON, without names of persons
};

using Hash = std::array<std::uint8_t, 32>;

struct StoredEntry {
  std::int64_t number = 0;  // counts from 1
  Entry entry;
  Hash hash{};
};

}  // namespace axisgate::server::journal
