// What the journal has of one thing that happened.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "device/core/time.h"
#include "server/events/wall_time.h"

namespace axisgate::server::journal {

// The numbers are in the file: they never change.
enum class EntryKind {
  daemon_started = 1,
  daemon_ended = 2,
  entries_left_out = 3,
  journal_failed = 4,   // the disk refused it, from then on until this entry
  entries_dropped = 5,  // by age or size, up to a number
  motion_requested = 10,
  motion_started = 11,
  motion_ended = 12,
  stop_requested = 20,
  stop_ended = 21,         // it was seen to be obeyed, or was withdrawn
  emergency_latched = 22,  // nothing moves until emergency_cleared
  emergency_cleared = 23,
  link_changed = 30,
  barrier_entered = 31,
  foreign_motion = 32,
  condition_changed = 33,  // an emergency stop, a limit sensor, a motor, the mode: at the stage itself
  switches_changed = 40,
  request_made = 50,     // what somebody wants to change or move; on the disk before it is done
  request_refused = 51,  // nothing was sent
  request_ended = 52,    // of one that is no motion
  lines_exchanged = 60,  // of no motion, or more of one than its start and end have
  lease_granted = 70,
  lease_ended = 71,
  latched = 72,  // the caller, by a stop of somebody else
  rearmed = 73,
  person_erased = 80,  // the name of a caller
  job_changed = 90,    // of a mill: it was queued, has another state, or was moved in the queue
};
// "motion ended" and the like; "kind 77" of a number that this program does not know.
std::string name(EntryKind kind);

struct Entry {
  EntryKind kind = EntryKind::daemon_started;
  WallTime time{};
  TimePoint boot_time{};     // since the machine's boot: a clock that is set does not change it
  std::string device{};      // empty: the daemon's own
  std::string who{};         // the caller; empty: nobody
  std::uint64_t motion = 0;  // its number; 0: none
  std::string body{};        // JSON, without names of persons
};

using Hash = std::array<std::uint8_t, 32>;

struct StoredEntry {
  std::int64_t number = 0;  // counts from 1
  Entry entry;
  Hash hash{};
};

}  // namespace axisgate::server::journal
