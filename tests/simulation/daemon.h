// The daemon without its threads, in virtual time: the state that a kill loses, and the state that the next start
// finds.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "device/stage/stage_controller.h"
#include "server/access/leases.h"
#include "server/devices/motion_record.h"
#include "server/devices/stop_record.h"
#include "server/journal/device_entries.h"
#include "server/journal/journal.h"
#include "server/journal/request_memory.h"

namespace axisgate::simulation {

inline constexpr const char* kDevice = "stage";

// The state directory, in memory if the machine has a memory disk: a kill preserves everything committed, synced or
// not.
class StateFolder {
 public:
  StateFolder();
  ~StateFolder();
  StateFolder(const StateFolder&) = delete;
  StateFolder& operator=(const StateFolder&) = delete;

  std::string journal() const { return path_ + "/journal.sqlite"; }
  std::string motions() const { return path_ + "/motions"; }
  std::string stops() const { return path_ + "/stops"; }

  // Saves a copy of the journal, and restores it. Nobody may write in between.
  void keep_journal() const;
  void put_journal_back() const;

 private:
  const std::string path_;
};

// One run of the daemon. The journal is the real one with its thread, to which DeviceEntries and settle_what_was_left()
// write. This class waits for the journal's commits, so that every run of a seed is the same.
class Daemon {
 public:
  // `generation` must be greater for each run. Throws if the files cannot be opened.
  Daemon(const StateFolder& folder, const server::journal::MemoryBounds& bounds, std::uint32_t generation);

  server::Leases& leases() { return leases_; }
  server::journal::RequestMemory& requests() { return requests_; }
  server::journal::Journal& journal() { return *journal_; }

  // Does the same with the state of the last run as server::Gateway, server::Stage and then axisgated.cc.
  void prepare(stage::StageController& controller, TimePoint now);
  // Handles an event like server::DeviceEvents.
  void on_event(const stage::Event& event, TimePoint now);

  // Makes the disk hang. Everything written after this call is lost with this run.
  void let_disk_hang();
  bool disk_hangs() const { return disk_hangs_; }

 private:
  const StateFolder& folder_;
  server::LeaseTokens tokens_;
  server::Leases leases_{tokens_};
  std::unique_ptr<server::journal::Journal> journal_;
  server::journal::RequestMemory requests_;
  std::unique_ptr<server::MotionRecord> record_;
  std::unique_ptr<server::StopRecord> stops_;
  server::journal::DeviceEntries entries_;
  bool disk_hangs_ = false;
};

// A request that changes something, on its path through memory and journal. It does the same calls in the same order as
// api::Mutation, but without the threads, which virtual time lacks.
class Mutation {
 public:
  // `daemon` must outlive this object.
  Mutation(Daemon& daemon, server::journal::RequestChange begun);

  // Does the same as api::Mutation::intend(), but waits for the disk. Fails with journal_unavailable if the disk hangs.
  Result<void> intend(TimePoint now);
  void acted(std::optional<std::string> answer);
  // Returns true if the id is free again.
  bool failed(const Problem& problem);

 private:
  void write(server::journal::EntryKind kind, std::optional<server::journal::RequestChange> change);

  Daemon& daemon_;
  const server::journal::RequestChange begun_;
  const server::journal::RequestMemory::Key key_;
};

}  // namespace axisgate::simulation
