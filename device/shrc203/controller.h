// Public interface of this folder: one SHRC-203, as callers see it.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "device/shrc203/profile.h"
#include "device/shrc203/stage.h"
#include "device/stage/stage_controller.h"

namespace axisgate::shrc203 {

// Implementation of StageController, which documents the functions. A jog is stopped by L:.
class Controller : public StageController {
 public:
  // Gives everybody all rights.
  Controller(Profile profile, ByteLink& link, EventSink& events);
  // `permission` must outlive the controller.
  Controller(Profile profile, ByteLink& link, EventSink& events, Permission& permission);
  ~Controller() override;

  void link_up(TimePoint now) override;
  void link_down(TimePoint now, std::string_view why) override;
  void receive(std::string_view bytes, TimePoint now) override;
  void advance(TimePoint now) override;
  std::optional<TimePoint> next_deadline() const override;
  const Profile& profile() const override;
  const State& state() const override;
  void refresh(Duration max_age, const RequestContext& context, TimePoint now, OnState done) override;
  void move(MoveRequest request, TimePoint now, OnStarted started) override;
  void home(HomeRequest request, TimePoint now, OnStarted started) override;
  void return_to_origin(HomeRequest request, TimePoint now, OnStarted started) override;
  void run_path(PathRequest request, TimePoint now, OnStarted started) override;
  void scan(ScanRequest request, TimePoint now, OnStarted started) override;
  void go_to_position(GoToPositionRequest request, TimePoint now, OnStarted started) override;
  MotionId jog(JogRequest request, TimePoint now, OnStarted started) override;
  Result<void> renew_jog(MotionId id, const std::vector<JogRequest::Axis>& speeds, TimePoint now) override;
  void end_jog(MotionId id, std::optional<Problem> why, TimePoint now) override;
  Result<void> check_use(const RequestContext& context, AxisSet axes) override;
  Result<void> check_up() const override;
  Result<void> check(const MoveRequest& request) const override;
  Result<void> check(const PathRequest& request) const override;
  Result<void> check(const ScanRequest& request) const override;
  Result<void> check(const GoToPositionRequest& request) const override;
  void stop(AxisSet axes, const RequestContext& context, TimePoint now, OnStopped done) override;
  void emergency_stop(const RequestContext& context, TimePoint now, OnStopped done) override;
  void withdraw_stop(StopId id, const RequestContext& context, TimePoint now, OnDone done) override;
  void clear_errors(AxisSet axes, const RequestContext& context, TimePoint now, OnDone done) override;
  void execute(ExecuteRequest request, TimePoint now, OnExecute event) override;
  std::vector<Motion> motions() const override;
  std::optional<Motion> find_motion(MotionId id) const override;
  void cancel_motion(MotionId id, const RequestContext& context, TimePoint now, OnDone done) override;
  std::size_t queued(Lane lane) const override;
  int outstanding_answers() const override;
  void inherit(const stage::Inheritance& left, TimePoint now) override;
  void number_motions_after(MotionId last) override;
  void wind_down(TimePoint now, OnWoundDown done) override;

 private:
  // The rooms are defined and wired in controller.cc.
  struct Rooms;

  template <class Call>
  void at(TimePoint now, Call call);
  template <class Answer, class Call>
  void unless_ending(const Answer& answer, TimePoint now, Call call);

  std::unique_ptr<Rooms> rooms_;
};

}  // namespace axisgate::shrc203
