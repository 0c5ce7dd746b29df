// Controller of a SHOT-1, SHOT-2 or SHOT-8: moves and homes its axes, one motion at a time, over the line of its
// family.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/tasks.h"
#include "device/shot/line/line.h"
#include "device/stage/envelope.h"
#include "device/stage/stage_controller.h"
#include "device/use/permission.h"
#include "tests/shot/model.h"

namespace axisgate::shot2 {

class Controller final : public StageController, private LineListener {
 public:
  // The referenced objects must outlive the controller.
  Controller(const Model& model, shot::Profile profile, ByteLink& link, EventSink& events, Permission& permission);

  void link_up(TimePoint now) override;
  void link_down(TimePoint now, std::string_view why) override;
  void receive(std::string_view bytes, TimePoint now) override;
  void advance(TimePoint now) override;
  std::optional<TimePoint> next_deadline() const override;

  const stage::Profile& profile() const override { return profile_; }
  const State& state() const override { return state_; }
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
  void clear_errors(AxisSet axes, const RequestContext& context, TimePoint now, OnDone done) override;
  void execute(ExecuteRequest request, TimePoint now, OnExecute event) override;
  std::vector<Motion> motions() const override;
  std::optional<Motion> find_motion(MotionId id) const override;
  void cancel_motion(MotionId id, const RequestContext& context, TimePoint now, OnDone done) override;
  std::size_t queued(Lane lane) const override { return line_.queued(lane); }
  int outstanding_answers() const override { return line_.outstanding(); }
  void number_motions_after(MotionId last) override { last_motion_ = last; }
  void wind_down(TimePoint now, OnWoundDown done) override;

 private:
  using Targets = std::map<int, std::int64_t>;  // in pulses, by axis
  struct Live {
    Motion motion;
    RequestContext context;
    OnStarted on_started;
    std::optional<Targets> targets;  // nullopt: an origin return
    std::string stopped_by;          // empty: not stopped
  };
  using LivePtr = std::shared_ptr<Live>;
  struct OpenStop {
    AxisSet axes;
    OnStopped done;
  };

  // controller.cc: requests
  template <class Call>
  void at(TimePoint now, Call call);
  tl::unexpected<Problem> cannot() const;
  Result<Targets> plan(const MoveRequest& request) const;
  void begin(MotionKind kind, AxisSet axes, std::optional<Targets> targets, RequestContext context, OnStarted started);

  // session.cc: the line, readings, stops
  void line_opened(TimePoint) override {}
  std::vector<ExchangeRequest> stops_to_write(std::string_view heard, TimePoint now) override;
  bool stop_is_open() const override { return !stops_.empty(); }
  void line_connected(const Identity& identity, const std::optional<std::string>& line_before, TimePoint now) override;
  void line_trusted(TimePoint now) override;
  void line_lost(const std::string& why, TimePoint now) override;
  void barrier_entered(const std::string& why, TimePoint now) override;
  void barrier_passed(const Identity& identity, TimePoint now) override;
  void restart_suspected(TimePoint now) override;
  void same_controller(TimePoint) override {}
  void completion_seen(int axis, bool doubtful, TimePoint now) override;
  void line_event(const Event& event, TimePoint now) override { events_.on_event(event, now); }
  std::optional<Problem> may_write(const ExchangeRequest& request, TimePoint now) override;
  ExchangeRequest request_of(Command command, Lane lane, const std::string& who) const;
  ExchangeRequest stop_of(AxisSet axes) const;
  std::vector<AxisSet> by_letter(AxisSet axes) const;
  Task<void> shake_hands(Identity identity);
  Task<Result<void>> read(Lane lane, std::string who, bool handshake = false);
  Task<void> refresh_for(RequestContext context, OnState done);
  Task<void> carry_out(std::shared_ptr<OpenStop> stop);
  Task<void> poll();
  Task<void> end_all(OnWoundDown done);
  void stop_axes(AxisSet axes, const std::string& who, OnStopped done);
  void carry_out_orders();
  void show_link(LinkState link, std::string why);

  // motions.cc
  Task<void> run(LivePtr live);
  Task<Result<void>> start(const LivePtr& live);
  Task<Result<void>> set_targets(const LivePtr& live, AxisSet axes);
  Task<Result<void>> go(const LivePtr& live, AxisSet axes);
  Task<void> watch(const LivePtr& live);
  void judge(const LivePtr& live);
  void end(const LivePtr& live, MotionState outcome, std::optional<Problem> problem);
  LivePtr find(MotionId id) const;
  void emit(const Event& event) { events_.on_event(event, tasks_.now()); }

  const Model& model_;
  const shot::Profile profile_;
  EventSink& events_;
  Permission& permission_;
  Tasks tasks_;
  const Executor& executor_ = tasks_.executor();
  State state_;
  Line line_;
  std::uint64_t connection_ = 0;     // counts connects and losses
  Signal moved_{tasks_.executor()};  // a motion has ended, or a stop was answered
  std::deque<LivePtr> live_;         // the first motion has its turn
  std::deque<Motion> ended_;
  MotionId last_motion_ = 0;
  std::vector<std::shared_ptr<OpenStop>> stops_;
  std::optional<Problem> ending_;  // answer to all later requests
};

}  // namespace axisgate::shot2
