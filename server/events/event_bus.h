// Facts of all devices in one numbered sequence, kept for readers that come late or come back.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "device/core/time.h"
#include "device/jobs/job.h"
#include "device/jobs/sending.h"
#include "device/stage/event.h"
#include "server/events/wake_ups.h"
#include "server/events/wall_time.h"

namespace axisgate::server {

// First fact of a run of the daemon; it belongs to no device.
struct DaemonStarted {
  bool after_unclean_end = false;  // the previous run was killed: its last facts may be missing
};

// A job of a mill was added, has changed its state, or is sent differently than before: paused or resumed.
struct JobChanged {
  jobs::Job job;
  std::optional<jobs::SenderState> sending{};  // of a running job
  std::string who{};                           // caller who requested it; empty: no caller
  std::string why{};                           // for people; may be empty
};

// A Fact is delivered to every watcher exactly once and in order. Telemetry is delivered separately: newest.h.
using Fact =
    std::variant<stage::MotionChanged, stage::CompletionSeen, stage::PathProgress, stage::LinkChanged,
                 stage::StopRequested, stage::StopChanged, stage::EmergencyLatchChanged, stage::ForeignMotion,
                 stage::ConditionChanged, stage::SwitchesChanged, stage::ProgramNotice, DaemonStarted, JobChanged>;

struct FactRecord {
  std::uint64_t revision = 0;  // ascends over all devices, and over all kept runs of the daemon
  std::string device;          // empty: a fact of the daemon itself
  WallTime time{};             // whole microseconds
  Fact fact;
  Moment clock{};     // converts the times in the fact; the same for all facts of a motion
  std::string run{};  // run of the daemon that published it
};
using FactPointer = std::shared_ptr<const FactRecord>;

// FactsBefore is the initial content of a bus.
struct FactsBefore {
  std::vector<FactPointer> facts{};  // of earlier runs, in order of revision
  std::uint64_t first = 1;           // first revision of this run; greater than those of `facts`
};

// Thread safe. Publishing never waits for a reader.
class EventBus {
 public:
  static constexpr std::size_t kFactsKept = 10'000;

  // Called with each published fact, in their order, so that it outlives the daemon. Must not wait, and must not use
  // the bus. Facts with revisions below `oldest` are no longer kept.
  using Keep = std::function<void(FactPointer fact, std::uint64_t oldest)>;

  // `run` is the run of the facts that are published here. `before` has at most `facts_kept` facts.
  explicit EventBus(Executor executor, std::string run = {}, FactsBefore before = {}, Keep keep = {},
                    std::size_t facts_kept = kFactsKept);

  // `clock` is needed for a fact with times in it: see FactRecord.
  std::uint64_t publish(std::string device, Fact fact, WallTime time, Moment clock = {});

  // Returns one less than the first revision of this run until a fact is published.
  std::uint64_t newest_revision() const;

  struct Reading {
    std::vector<FactPointer> facts;
    std::uint64_t next = 1;  // revision for the next read()
    // True if `from` is no longer kept, or is beyond the next revision, as a revision of another run of the daemon may
    // be. Then nothing is read, and `next` is the oldest available revision.
    bool compacted = false;
  };
  // Returns at most `limit` facts, from revision `from` on; 0: from the oldest kept one.
  Reading read(std::uint64_t from, std::size_t limit) const;

  // Reports whether a reader of that run may resume at `from`: the first fact from there on, or the last one before it,
  // belongs to the run. Revisions of runs that were not kept are assigned again; this check detects them.
  bool resumes(std::string_view run, std::uint64_t from) const;

  // Returns the newest fact about a motion, also of an earlier run; null if none is kept.
  FactPointer find_motion(const std::string& device, stage::MotionId motion) const;
  // Returns the newest fact about each motion without an outcome.
  std::vector<FactPointer> open_motions() const;

  // Calls `wake` after facts were published, possibly once for several facts.
  std::unique_ptr<WakeUps::Subscription> subscribe(std::function<void()> wake);

 private:
  using Facts = std::deque<FactPointer>;

  // Called under mutex_.
  void add(FactPointer record);
  void forget_oldest();
  std::uint64_t oldest() const { return facts_.empty() ? newest_ + 1 : facts_.front()->revision; }
  Facts::const_iterator find(std::uint64_t revision) const;  // first fact from that revision on

  const std::string run_;
  const Keep keep_;
  const std::size_t facts_kept_;
  mutable std::mutex mutex_;
  Facts facts_;
  std::map<std::pair<std::string, stage::MotionId>, FactPointer> motions_;  // newest fact of facts_ about each motion
  std::uint64_t newest_ = 0;
  WakeUps wake_ups_;
};

}  // namespace axisgate::server
