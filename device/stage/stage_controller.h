// A stage controller of any kind, as the gateway sees it: a machine on a line that moves axes and says what became of
// it.
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

// Not thread safe: every member is called on the device's strand. Callbacks are called on it too, after the call that
// took them has returned or from within it, once each (ExecuteEvents until `ended`).
class StageController : public LineMachine {
 public:
  virtual const Profile& profile() const = 0;
  virtual const State& state() const = 0;

  // The state, read again from the device when it is older than `max_age`; link_down while the device is not up.
  using OnState = std::function<void(Result<State>)>;
  virtual void refresh(Duration max_age, const RequestContext& context, TimePoint now, OnState done) = 0;

  // Answers once the motion has started (state running or already beyond), or with the problem that kept it from it.
  using OnStarted = std::function<void(Result<Motion>)>;
  virtual void move(MoveRequest request, TimePoint now, OnStarted started) = 0;
  virtual void home(HomeRequest request, TimePoint now, OnStarted started) = 0;
  virtual void return_to_origin(HomeRequest request, TimePoint now, OnStarted started) = 0;
  virtual void run_path(PathRequest request, TimePoint now, OnStarted started) = 0;
  virtual void scan(ScanRequest request, TimePoint now, OnStarted started) = 0;
  virtual void go_to_position(GoToPositionRequest request, TimePoint now, OnStarted started) = 0;

  // The axes run for as long as renew_jog() comes, at most kJogSilence apart: beyond that, at the end of the caller's
  // right to them, and before a travel limit they are stopped. Answers as move() does; with the motion's number
  // at once, 0 where it was refused.
  static constexpr Duration kJogSilence = std::chrono::milliseconds(500);
  virtual MotionId jog(JogRequest request, TimePoint now, OnStarted started) = 0;
  // Lets it run on; at other speeds for the axes of `speeds` (directions do not count). unknown_axis, too_fast,
  // out_of_range, not_found once it has ended.
  virtual Result<void> renew_jog(MotionId id, const std::vector<JogRequest::Axis>& speeds, TimePoint now) = 0;
  // Stops it: succeeded where the caller wanted that, else stopped, with the reason.
  virtual void end_jog(MotionId id, std::optional<Problem> why, TimePoint now) = 0;

  // Whether the caller may change something of these axes now: lease_held, lease_lost, outside_lease, stopped_by,
  // epoch_passed.
  virtual Result<void> check_use(const RequestContext& context, AxisSet axes) = 0;

  // Whether the device can be commanded now: link_down; wrong_mode if a person must first correct something at its
  // front panel; not_sent after wind_down().
  virtual Result<void> check_up() const = 0;

  // The same checks as the calls above, and nothing is sent.
  virtual Result<void> check(const MoveRequest& request) const = 0;
  virtual Result<void> check(const PathRequest& request) const = 0;
  virtual Result<void> check(const ScanRequest& request) const = 0;
  virtual Result<void> check(const GoToPositionRequest& request) const = 0;

  // Answers when the axes are stationary or the wait for that has run out; the stop itself stays open until they were
  // seen stationary, and is repeated over reconnects. Empty: all controllable axes. Needs no lease.
  using OnStopped = std::function<void(StopReport)>;
  virtual void stop(AxisSet axes, const RequestContext& context, TimePoint now, OnStopped done) = 0;
  // The same for all axes. From now on all motion is refused, until clear_errors() for all axes.
  virtual void emergency_stop(const RequestContext& context, TimePoint now, OnStopped done) = 0;

  using OnDone = std::function<void(Result<void>)>;
  // Abandons an open stop whose controller will never answer again. Fails with not_found.
  virtual void withdraw_stop(StopId, const RequestContext&, TimePoint, OnDone done) {
    done(fail(Reason::not_found, "this kind of controller has no open stops"));
  }
  virtual void clear_errors(AxisSet axes, const RequestContext& context, TimePoint now, OnDone done) = 0;

  using OnExecute = std::function<void(const ExecuteEvent&)>;
  virtual void execute(ExecuteRequest request, TimePoint now, OnExecute event) = 0;

  // The newest kMotionsKept motions; unfinished ones are always kept.
  static constexpr std::size_t kMotionsKept = 1000;
  virtual std::vector<Motion> motions() const = 0;  // oldest first
  virtual std::optional<Motion> find_motion(MotionId id) const = 0;
  virtual void cancel_motion(MotionId id, const RequestContext& context, TimePoint now, OnDone done) = 0;

  virtual std::size_t queued(Lane lane) const = 0;
  // Answers to abandoned probes of the line that may still come.
  virtual int outstanding_answers() const = 0;

  // Before link_up(): what the run before this one left. Its motions are stopped, or finish if the profile's at_exit
  // lets motions finish; a jog is always stopped. UnfinishedJudged says what was found.
  virtual void inherit(const Inheritance&, TimePoint /*now*/) {}
  // Once, before the first request: the next motion has the number behind this one. Otherwise they count from 1.
  virtual void number_motions_after(MotionId last) = 0;

  // The end, called once. From now on everything but a stop is refused with not_sent, and so end motions that wait.
  // Motions that run are stopped, or with AtExit::finish waited for and stopped when kFinishLimit has passed. Answers
  // when all have their outcomes, which are unknown after kStopLimit, and the exchange on the wire has ended; nothing
  // but a stop is written any more then.
  static constexpr Duration kFinishLimit = std::chrono::seconds(60), kStopLimit = std::chrono::seconds(10);
  using OnWoundDown = std::function<void(WindDownReport)>;
  virtual void wind_down(TimePoint now, OnWoundDown done) = 0;
};

}  // namespace axisgate::stage
