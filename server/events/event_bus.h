// The facts of all devices in one numbered row, kept for readers that come late or come back.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <variant>
#include <vector>

#include "device/core/time.h"
#include "device/stage/event.h"
#include "server/events/wake_ups.h"
#include "server/events/wall_time.h"

namespace axisgate::server {

// What every watcher receives, each exactly once and in order. Telemetry is not part of it: newest.h.
using Fact = std::variant<stage::MotionChanged, stage::CompletionSeen, stage::PathProgress, stage::LinkChanged,
                          stage::StopRequested, stage::ForeignMotion, stage::SwitchesChanged, stage::ProgramNotice>;

struct FactRecord {
  std::uint64_t revision = 0;  // counts from 1 as long as the daemon runs, over all devices
  std::string device;
  WallTime time{};
  Fact fact;
  Moment clock{};  // of a motion's fact: that of all facts of the motion, by which its times are shown
};

// Thread safe. Publishing never waits for a reader.
class EventBus {
 public:
  static constexpr std::size_t kFactsKept = 10'000;

  explicit EventBus(Executor executor, std::size_t facts_kept = kFactsKept);

  // `clock`: of a motion's fact, as in FactRecord.
  std::uint64_t publish(std::string device, Fact fact, WallTime time, Moment clock = {});

  // 0 before the first fact.
  std::uint64_t newest_revision() const;

  struct Reading {
    std::vector<std::shared_ptr<const FactRecord>> facts;
    std::uint64_t next = 1;  // the revision to ask for next
    // `from` is no longer kept, or lies beyond the next revision, as one of another run of the daemon may: nothing is
    // read, and `next` is the oldest revision that can be had.
    bool compacted = false;
  };
  // The facts from revision `from` on, at most `limit`; 0 means the oldest that is kept.
  Reading read(std::uint64_t from, std::size_t limit) const;

  // `wake` is called after facts were published: read again. It says only that, and may come once for many facts.
  std::unique_ptr<WakeUps::Subscription> subscribe(std::function<void()> wake);

 private:
  const std::size_t facts_kept_;
  mutable std::mutex mutex_;
  std::deque<std::shared_ptr<const FactRecord>> facts_;
  std::uint64_t newest_ = 0;
  WakeUps wake_ups_;
};

}  // namespace axisgate::server
