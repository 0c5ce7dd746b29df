// Stop goes first: L: and L:E, and what follows from them. Not a safety function.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "device/core/tasks.h"
#include "device/shrc203/session/dialogue.h"
#include "device/shrc203/session/reader.h"
#include "device/shrc203/state/motions.h"
#include "device/shrc203/state/non_host.h"
#include "device/shrc203/state/registers.h"
#include "device/shrc203/state/state_store.h"
#include "device/shrc203/state/stop_life.h"
#include "device/shrc203/state/violations.h"

namespace axisgate::shrc203 {

class Stops {
 public:
  using OnStopped = StageController::OnStopped;
  using OnDone = StageController::OnDone;

  Stops(Dialogue& dialogue, Line& line, Reader& reader, StateStore& store, Motions& motions, const Registers& registers,
        const NonHost& non_host, Tasks& tasks, Violations& violations)
      : dialogue_(dialogue),
        line_(line),
        reader_(reader),
        store_(store),
        motions_(motions),
        registers_(registers),
        non_host_(non_host),
        tasks_(tasks),
        violations_(violations) {}

  // No axes: all. Where the same one is pending, this joins it.
  void stop(AxisSet axes, StopKind kind, const RequestContext& context, OnStopped done);
  // For which nobody waits.
  void stop(AxisSet axes, const RequestContext& context) {
    stop(axes, StopKind::stop, context, [](const StopReport&) {});
  }
  // Stops the motion, or turns it away where it waits. not_found; what the stop reports.
  void cancel(MotionId id, const RequestContext& context, OnDone done);

  bool pending() const { return !jobs_.empty(); }

 private:
  void withdraw_motions(AxisSet axes, const RequestContext& context);
  Task<void> run(StopJobPtr job);
  void change(StopJob& job, StopEvent event);
  bool has_no_use(StopJob& job) const;
  Problem unseen() const;
  void add_caller(const StopJobPtr& job, const RequestContext& context, OnStopped done);
  void answer(StopJob& job, std::size_t caller);
  void answer_soon(const StopJobPtr& job);
  Task<void> answer_at(StopJobPtr job, std::size_t caller, TimePoint limit);
  AxisSet excited(const StopJob& job) const;
  Command command_for(const StopJob& job, AxisSet axes) const;
  Task<ExchangeResult> write_line(StopJobPtr job, Command command);
  Task<void> write(StopJobPtr job);
  Duration slowing(AxisSet axes) const;
  Task<bool> look(StopJobPtr job);
  Task<bool> write_again(StopJobPtr job);
  Task<void> wait_for_standstill(StopJobPtr job);
  Task<bool> prebuffer_is_empty(StopJobPtr job);

  Dialogue& dialogue_;
  Line& line_;
  Reader& reader_;
  StateStore& store_;
  Motions& motions_;
  const Registers& registers_;
  const NonHost& non_host_;
  Tasks& tasks_;
  Violations& violations_;
  std::vector<StopJobPtr> jobs_;
};

}  // namespace axisgate::shrc203
