// A daemon without its threads, in virtual time: what of it is gone when it is killed, and what it finds when it starts
// again.
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

// The state directory. It is in memory where the machine has that: a kill leaves what was committed, synced or not.
class StateFolder {
 public:
  StateFolder();
  ~StateFolder();
  StateFolder(const StateFolder&) = delete;
  StateFolder& operator=(const StateFolder&) = delete;

  std::string journal() const { return path_ + "/journal.sqlite"; }
  std::string motions() const { return path_ + "/motions"; }
  std::string stops() const { return path_ + "/stops"; }

  // Keeps the journal as it is; the other puts it back. Nobody may write meanwhile.
  void keep_journal() const;
  void put_journal_back() const;

 private:
  const std::string path_;
};

// One run of it. The journal is the real one with its thread, which DeviceEntries and settle_what_was_left() write to;
// this class waits for its commits, so that every run of a seed is the same.
class Daemon {
 public:
  // `generation`: a greater one for each run. Throws where the files cannot be opened.
  Daemon(const StateFolder& folder, const server::journal::MemoryBounds& bounds, std::uint32_t generation);

  server::Leases& leases() { return leases_; }
  server::journal::RequestMemory& requests() { return requests_; }
  server::journal::Journal& journal() { return *journal_; }

  // As server::Gateway and server::Stage do with what was left, and axisgated.cc behind them.
  void prepare(stage::StageController& controller, TimePoint now);
  // As server::DeviceEvents.
  void on_event(const stage::Event& event, TimePoint now);

  // From now on the disk takes nothing: it hangs. What is written from now on is lost with this run.
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

// A request that changes something, on its way through memory and journal: api::Mutation, whose threads virtual time
// does not have. The calls and their order are the same.
class Mutation {
 public:
  // `daemon` outlives it.
  Mutation(Daemon& daemon, server::journal::RequestChange begun);

  // As api::Mutation::intend(), but it waits for the disk. journal_unavailable.
  Result<void> intend(TimePoint now);
  void acted(std::optional<std::string> answer);
  // True: its id is free again.
  bool failed(const Problem& problem);

 private:
  void write(server::journal::EntryKind kind, std::optional<server::journal::RequestChange> change);

  Daemon& daemon_;
  const server::journal::RequestChange begun_;
  const server::journal::RequestMemory::Key key_;
};

}  // namespace axisgate::simulation
