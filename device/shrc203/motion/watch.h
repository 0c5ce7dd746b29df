// Watch over a started motion until its outcome: a completion triggers the check; READY, no error and the exact target
// make the success.
#pragma once

#include <optional>
#include <set>

#include "device/core/tasks.h"
#include "device/shot/line/line.h"
#include "device/shrc203/motion/ready_lag.h"
#include "device/shrc203/motion/starter.h"
#include "device/shrc203/motion/trigger_count.h"
#include "device/shrc203/session/reader.h"
#include "device/shrc203/state/motions.h"
#include "device/shrc203/state/state_store.h"

namespace axisgate::shrc203 {

class Watch {
 public:
  Watch(const Line& line, Reader& reader, TriggerCount& triggers, StateStore& store, Motions& motions, Tasks& tasks)
      : line_(line), reader_(reader), triggers_(triggers), store_(store), motions_(motions), tasks_(tasks) {}

  // Watches the motion until it has its outcome. `wake_ups` is the part of LiveMotion::wake_ups that had other causes.
  Task<void> run(LiveMotionPtr live, Start start, int wake_ups = 0);
  // Reports whether the positions of any motion are being read.
  bool watches_any() const;

 private:
  // Observations up to now.
  struct Seen {
    TimePoint begun{};
    Start start = Start::accepted;
    int wake_ups = 0;
    std::optional<TimePoint> completed_at{};  // time at which all completions had arrived
    Duration ready_pause{};                   // newest pause since then
    bool busy = false;
    std::optional<Positions> ready_at{};  // positions at the last READY; away from the target two must agree
  };

  Task<void> wait_for_change(LiveMotionPtr live, Seen& seen, TimePoint limit);
  Task<void> wait_for_ready(LiveMotionPtr live, Seen& seen);
  void learn_lag(const LiveMotion& live, const Seen& seen, TimePoint asked);
  Duration pause_after(const LiveMotion& live, Seen& seen, bool hinted) const;
  Duration pause_on_the_way(const LiveMotion& live) const;
  Task<Result<void>> read_end(LiveMotionPtr live, const Seen& seen);
  void unreadable(LiveMotion& live, const Problem& problem);
  void judge(LiveMotion& live, Seen& seen);
  bool has_succeeded(const LiveMotion& live, const Seen& seen, const Positions& here) const;
  void judge_end(LiveMotion& live, const Seen& seen);
  void judge_jog(LiveMotion& live);
  bool at_targets(const LiveMotion& live) const;
  bool axis_busy(const LiveMotion& live) const;

  const Line& line_;
  Reader& reader_;
  TriggerCount& triggers_;
  StateStore& store_;
  Motions& motions_;
  Tasks& tasks_;
  ReadyLag ready_lag_;
  std::set<MotionId> watched_;
};

}  // namespace axisgate::shrc203
