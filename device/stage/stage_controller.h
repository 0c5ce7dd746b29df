// A stage controller of any kind: a device on a line that moves axes and reports the outcomes.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "device/core/lane.h"
#include "device/core/line_machine.h"
#include "device/core/problem.h"
#include "device/stage/event.h"
#include "device/stage/motion.h"
#include "device/stage/profile.h"
#include "device/stage/requests.h"
#include "device/stage/state.h"
#include "device/stage/unfinished.h"

namespace axisgate::stage {

// Not thread safe: every member must be called on the device's strand. Callbacks run on the strand too, during or after
// the call that took them, once each (OnExecute until `ended`).
class StageController : public LineMachine {
 public:
  virtual const Profile& profile() const = 0;
  virtual const State& state() const = 0;

  // Returns the state, read again from the device if it is older than `max_age`. Fails with link_down while the device
  // is not up.
  using OnState = std::function<void(Result<State>)>;
  virtual void refresh(Duration max_age, const use::RequestContext& context, TimePoint now, OnState done) = 0;

  // Called once the motion has started (state running or later), or with the problem that prevented the start.
  using OnStarted = std::function<void(Result<Motion>)>;
  virtual void move(MoveRequest request, TimePoint now, OnStarted started) = 0;
  virtual void home(HomeRequest request, TimePoint now, OnStarted started) = 0;
  virtual void return_to_origin(HomeRequest request, TimePoint now, OnStarted started) = 0;
  virtual void run_path(PathRequest request, TimePoint now, OnStarted started) = 0;
  virtual void scan(ScanRequest request, TimePoint now, OnStarted started) = 0;
  virtual void go_to_position(GoToPositionRequest request, TimePoint now, OnStarted started) = 0;

  // Runs axes as long as renew_jog() is called at least every kJogSilence. Otherwise, when the caller loses the right
  // to the axes, and before a travel limit, the axes are stopped. `started` is called as for move(). Returns the
  // motion's number at once; 0 if it was refused.
  static constexpr Duration kJogSilence = std::chrono::milliseconds(500);
  virtual MotionId jog(JogRequest request, TimePoint now, OnStarted started) = 0;
  // Continues the jog; at other speeds for the axes of `speeds` (directions are ignored). Fails with unknown_axis,
  // too_fast, out_of_range, or not_found if the jog has ended.
  virtual Result<void> renew_jog(MotionId id, const std::vector<JogRequest::Axis>& speeds, TimePoint now) = 0;
  // Stops the jog. The outcome is succeeded if the caller ended it (`why` is nullopt), else stopped with the reason.
  virtual void end_jog(MotionId id, std::optional<Problem> why, TimePoint now) = 0;

  // Checks that the caller may change these axes now. Fails with lease_held, lease_lost, outside_lease, stopped_by or
  // epoch_passed.
  virtual Result<void> check_use(const use::RequestContext& context, AxisSet axes) = 0;

  // Checks that the device can take commands now. Fails with link_down; with wrong_mode if a person must first correct
  // something at the front panel; with not_sent after wind_down().
  virtual Result<void> check_up() const = 0;

  // Make the same checks as the calls above, and send nothing.
  virtual Result<void> check(const MoveRequest& request) const = 0;
  virtual Result<void> check(const PathRequest& request) const = 0;
  virtual Result<void> check(const ScanRequest& request) const = 0;
  virtual Result<void> check(const GoToPositionRequest& request) const = 0;

  // Stops axes; empty: all controllable axes. `done` is called when the axes are stationary or the wait for that has
  // timed out. The stop itself stays open, and is repeated across reconnects, until the axes are confirmed stationary.
  // Needs no lease.
  using OnStopped = std::function<void(StopReport)>;
  virtual void stop(AxisSet axes, const use::RequestContext& context, TimePoint now, OnStopped done) = 0;
  // Stops all axes in the same way, and refuses all motion until clear_errors() for all axes.
  virtual void emergency_stop(const use::RequestContext& context, TimePoint now, OnStopped done) = 0;

  using OnDone = std::function<void(Result<void>)>;
  // Abandons an open stop whose controller will never answer again. Fails with not_found.
  virtual void withdraw_stop(StopId, const use::RequestContext&, TimePoint, OnDone done) {
    done(fail(Reason::not_found, "this kind of controller has no open stops"));
  }
  virtual void clear_errors(AxisSet axes, const use::RequestContext& context, TimePoint now, OnDone done) = 0;

  using OnExecute = std::function<void(const ExecuteEvent&)>;
  virtual void execute(ExecuteRequest request, TimePoint now, OnExecute event) = 0;

  // Return the newest kMotionsKept motions; unfinished motions are always kept.
  static constexpr std::size_t kMotionsKept = 1000;
  virtual std::vector<Motion> motions() const = 0;  // oldest first
  virtual std::optional<Motion> find_motion(MotionId id) const = 0;
  virtual void cancel_motion(MotionId id, const use::RequestContext& context, TimePoint now, OnDone done) = 0;

  virtual std::size_t queued(Lane lane) const = 0;
  // Number of answers to abandoned probes that may still come.
  virtual int outstanding_answers() const = 0;

  // Takes over the state that the previous run left. Call before link_up(). Motions of that run are stopped, or may
  // finish if the profile's at_exit allows; a jog is always stopped. UnfinishedJudged reports the decision.
  virtual void inherit(const Inheritance&, TimePoint /*now*/) {}
  // Sets the number after which motions are numbered. Call once, before the first request. Without this call, motions
  // count from 1.
  virtual void number_motions_after(MotionId last) = 0;

  // Ends the controller's work; called once. From then on every request but a stop is refused with not_sent, and
  // waiting motions end in the same way. Running motions are stopped, or with AtExit::finish waited for and stopped
  // after kFinishLimit. `done` is called when every motion has its outcome (unknown after kStopLimit) and the exchange
  // in flight has ended; from then on only stops are written.
  static constexpr Duration kFinishLimit = std::chrono::seconds(60), kStopLimit = std::chrono::seconds(10);
  using OnWoundDown = std::function<void(WindDownReport)>;
  virtual void wind_down(TimePoint now, OnWoundDown done) = 0;
};

}  // namespace axisgate::stage
