// The stops that were not seen to be obeyed yet, and the latch of an emergency stop: what forbids motion until somebody
// has seen the axes stationary.
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

  // Takes over what the run before left open.
  std::vector<StopJobPtr> inherit(const std::vector<Stop>& stops, StopId last);

  StopJobPtr open(AxisSet axes, StopKind kind, const RequestContext& context);
  // Notes who requested it.
  void note_caller(StopJob& job, const std::string& who);
  // Notes that a caller was notified that the stop stays open.
  void note_late(StopJob& job);
  // Notes whether a prebuffer keeps a segment although the axes rest.
  void note_stale(StopJob& job, bool stale);
  void change(const StopJobPtr& job, StopEvent event);

  // Oldest first. A copy, since change() shortens the list.
  std::vector<StopJobPtr> all() const { return jobs_; }
  bool any() const { return !jobs_.empty(); }
  StopJobPtr find(StopId id) const;  // null if it is not open
  // Returns an open stop that includes these axes; null if none does.
  StopJobPtr including(AxisSet axes, StopKind kind) const;

  // The latch. An emergency stop sets it, whatever becomes of the stop.
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
