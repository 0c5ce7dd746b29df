// Stops by L: and L:E, which go before everything else: who requested them, and when each caller is answered. A stop
// stays open until it was seen to be obeyed, over barriers, reconnects and restarts of the gateway. Not a safety
// function.
#pragma once

#include <cstddef>
#include <functional>
#include <string_view>
#include <vector>

#include "device/core/tasks.h"
#include "device/shrc203/session/stop_look.h"
#include "device/shrc203/session/stop_writer.h"
#include "device/shrc203/state/motions.h"
#include "device/shrc203/state/open_stops.h"
#include "device/shrc203/state/state_store.h"
#include "device/stage/unfinished.h"

namespace axisgate::shrc203 {

class Stops {
 public:
  using OnStopped = StageController::OnStopped;
  using OnDone = StageController::OnDone;

  Stops(StopWriter& writer, StopLook& look, Line& line, StateStore& store, OpenStops& open, Motions& motions,
        Tasks& tasks)
      : writer_(writer),
        look_(look),
        line_(line),
        store_(store),
        open_(open),
        motions_(motions),
        tasks_(tasks),
        due_(tasks.executor()),
        seen_(tasks.executor()) {}

  // Stops these axes, or all if empty. Joins an open stop that includes them, and replaces open stops that it includes.
  void stop(AxisSet axes, StopKind kind, const RequestContext& context, OnStopped done);
  // Stops these axes without a caller who waits.
  void stop(AxisSet axes, const RequestContext& context) {
    stop(axes, StopKind::stop, context, [](const StopReport&) {});
  }
  // Stops the motion, or withdraws it while it waits. A motion that ended UNKNOWN is stopped until its axes were seen
  // stationary. Fails with not_found, and with the problem that the stop reports.
  void cancel(MotionId id, const RequestContext& context, OnDone done);
  // Abandons an open stop. Fails with not_found.
  void withdraw(StopId id, const RequestContext& context, const OnDone& done);
  // Takes over the open stops of the previous run. Call before the line is opened.
  void inherit(const stage::Inheritance& left);

  // Reports whether a caller waits for an answer.
  bool pending() const { return answering_ > 0; }

  // Called when the line reports these events.
  void line_opened() { wake(); }
  void barrier_entered();
  void line_answers();
  void line_lost();
  // Called when the handshake has seen an axis move.
  void axes_move();

 private:
  void wake();
  void withdraw_motions(AxisSet axes, const RequestContext& context);
  StopJobPtr begin(AxisSet axes, StopKind kind, const RequestContext& context);
  void replace_narrower(const StopJobPtr& wider);
  void add_caller(const StopJobPtr& job, AxisSet axes, const RequestContext& context, OnStopped done);
  void wait_with(const StopJobPtr& job, StopJob::Caller caller);
  Task<void> carry_out(StopJobPtr job);
  TimePoint next_step(const StopJob& job) const;
  Task<void> answer_in_time(StopJobPtr job, std::size_t caller);
  TimePoint limit_of(const StopJob& job, const StopJob::Caller& caller) const;
  bool is_over(const StopJob& job) const;
  void answer(StopJob& job, std::size_t caller);
  StopReport report_for(const StopJob& job, const StopJob::Caller& caller) const;
  Problem unseen(const StopJob& job) const;

  StopWriter& writer_;
  StopLook& look_;
  Line& line_;
  StateStore& store_;
  OpenStops& open_;
  Motions& motions_;
  Tasks& tasks_;
  Signal due_;         // wakes carry_out(): a stop must be written or looked at
  Signal seen_;        // wakes callers who wait for an answer
  int answering_ = 0;  // number of callers who wait
};

}  // namespace axisgate::shrc203
