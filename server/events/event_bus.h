// The facts of all devices in one numbered row, kept for readers that come late or come back.
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
#include "device/rml1/mill/job.h"
#include "device/rml1/sending/sender.h"
#include "device/stage/event.h"
#include "server/events/wake_ups.h"
#include "server/events/wall_time.h"

namespace axisgate::server {

// A run of the daemon began: its first fact, of no device.
struct DaemonStarted {
  bool after_unclean_end = false;  // the run before was killed: the last of its facts may be missing
};

// A job of a mill was added, has another state, or is sent otherwise than before: paused, or on again.
struct JobChanged {
  rml1::Job job;
  std::optional<rml1::SenderState> sending{};  // of one that runs
  std::string who{};                           // who requested it; empty: nobody
  std::string why{};                           // for people; may be empty
};

// What every watcher receives, each exactly once and in order. Telemetry is not part of it: newest.h.
using Fact =
    std::variant<stage::MotionChanged, stage::CompletionSeen, stage::PathProgress, stage::LinkChanged,
                 stage::StopRequested, stage::StopChanged, stage::EmergencyLatchChanged, stage::ForeignMotion,
                 stage::ConditionChanged, stage::SwitchesChanged, stage::ProgramNotice, DaemonStarted, JobChanged>;

struct FactRecord {
  std::uint64_t revision = 0;  // ascends over all devices, and over the runs of the daemon that are kept
  std::string device;          // empty: a fact of the daemon itself
  WallTime time{};             // in whole microseconds
  Fact fact;
  Moment clock{};     // by which the times in the fact are shown; of a motion, that of all of its facts
  std::string run{};  // of the daemon, in which it was published
};
using FactPointer = std::shared_ptr<const FactRecord>;

// What a bus begins with.
struct FactsBefore {
  std::vector<FactPointer> facts{};  // of earlier runs, by revision
  std::uint64_t first = 1;           // the first revision of this run; greater than all of those
};

// Thread safe. Publishing never waits for a reader.
class EventBus {
 public:
  static constexpr std::size_t kFactsKept = 10'000;

  // Called with each fact as it is published, in their order: by it a fact outlives the daemon. It may not wait, nor
  // use the bus. `oldest`: the facts below that revision are not kept any more.
  using Keep = std::function<void(FactPointer fact, std::uint64_t oldest)>;

  // `run`: of the facts that are published here. `before`: at most `facts_kept`.
  explicit EventBus(Executor executor, std::string run = {}, FactsBefore before = {}, Keep keep = {},
                    std::size_t facts_kept = kFactsKept);

  // `clock`: of a fact with times in it, as in FactRecord.
  std::uint64_t publish(std::string device, Fact fact, WallTime time, Moment clock = {});

  // The one before the first of this run, as long as nothing was published.
  std::uint64_t newest_revision() const;

  struct Reading {
    std::vector<FactPointer> facts;
    std::uint64_t next = 1;  // the revision to ask for next
    // `from` is no longer kept, or lies beyond the next revision, as one of another run of the daemon may: nothing is
    // read, and `next` is the oldest revision that can be had.
    bool compacted = false;
  };
  // The facts from revision `from` on, at most `limit`; 0 means the oldest that is kept.
  Reading read(std::uint64_t from, std::size_t limit) const;

  // Whether a reader of that run resumes at `from`: the first fact from there on is of that run, or the last before it.
  // Revisions of runs that were not kept are given again; by this they are found out.
  bool resumes(std::string_view run, std::uint64_t from) const;

  // The newest fact about a motion, also of an earlier run; null: none is kept.
  FactPointer find_motion(const std::string& device, stage::MotionId motion) const;
  // Of each motion without an outcome its newest fact.
  std::vector<FactPointer> open_motions() const;

  // `wake` is called after facts were published: read again. It says only that, and may come once for many facts.
  std::unique_ptr<WakeUps::Subscription> subscribe(std::function<void()> wake);

 private:
  using Facts = std::deque<FactPointer>;

  // Under mutex_.
  void add(FactPointer record);
  void forget_oldest();
  std::uint64_t oldest() const { return facts_.empty() ? newest_ + 1 : facts_.front()->revision; }
  Facts::const_iterator find(std::uint64_t revision) const;  // the first from there on

  const std::string run_;
  const Keep keep_;
  const std::size_t facts_kept_;
  mutable std::mutex mutex_;
  Facts facts_;
  std::map<std::pair<std::string, stage::MotionId>, FactPointer> motions_;  // of facts_ the newest about each
  std::uint64_t newest_ = 0;
  WakeUps wake_ups_;
};

}  // namespace axisgate::server
