// Stops that are not confirmed yet, and the latch of an emergency stop. Both forbid motion until the axes were seen
// stationary.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "device/core/problem.h"
#include "device/core/tasks.h"
#include "device/core/violations.h"
#include "device/shrc203/stage.h"
#include "device/shrc203/state/state_store.h"
#include "device/shrc203/state/stop_life.h"

namespace axisgate::shrc203 {

class OpenStops {
 public:
  OpenStops(StateStore& store, const Tasks& tasks, Violations& violations)
      : store_(store), tasks_(tasks), violations_(violations) {}

  // Takes over the open stops of the previous run.
  std::vector<StopJobPtr> inherit(const std::vector<Stop>& stops, StopId last);

  StopJobPtr open(AxisSet axes, StopKind kind, const RequestContext& context);
  // Adds a caller who requested the stop.
  void note_caller(StopJob& job, const std::string& who);
  // Notes that a caller was notified of the stop staying open.
  void note_late(StopJob& job);
  // Notes whether a prebuffer still has a segment although the axes are stationary.
  void note_stale(StopJob& job, bool stale);
  void change(const StopJobPtr& job, StopEvent event);

  // Oldest first. A copy, since change() shortens the list.
  std::vector<StopJobPtr> all() const { return jobs_; }
  bool any() const { return !jobs_.empty(); }
  StopJobPtr find(StopId id) const;  // null if it is not open
  // Returns an open stop that includes these axes; null if none does.
  StopJobPtr including(AxisSet axes, StopKind kind) const;

  // Sets the latch of an emergency stop, whatever becomes of the stop.
  void latch(const std::string& who);
  void inherit(const EmergencyLatch& latch);
  void unlatch(const std::string& who);

 private:
  void publish(const StopJob& job);
  void show_latch(std::optional<EmergencyLatch> latch, const std::string& who);

  StateStore& store_;
  const Tasks& tasks_;
  Violations& violations_;
  std::vector<StopJobPtr> jobs_;
  StopId last_ = 0;
};

}  // namespace axisgate::shrc203
