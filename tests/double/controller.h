// Stage controller for one rotor, with one axis, independent of the SHRC-203. Its motions take turns; requests that a
// rotor does not support are refused.
#pragma once

#include <deque>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "device/stage/envelope.h"
#include "device/stage/stage_controller.h"
#include "device/use/permission.h"
#include "device/use/request_context.h"
#include "tests/double/wire.h"

namespace axisgate::rotor {

using namespace stage;  // NOLINT(google-build-using-namespace)
using use::EndedLease;
using use::everybody_may;
using use::Occupation;
using use::Orders;
using use::Permission;
using use::RequestContext;
using use::StopOrder;
using use::Use;

inline constexpr AxisSet kAxis = AxisSet::of(1);
inline constexpr std::size_t kWaitingMax = 100;
inline constexpr std::int64_t kJogSpeed = 1000;  // pulses/s, if the caller names no speed

class Controller final : public StageController, private Wire::Listener {
 public:
  // `reversed`: callers count in the direction opposite to the rotor's. The referenced objects must outlive the
  // controller.
  Controller(Profile profile, bool reversed, ByteLink& link, EventSink& events, Permission& permission);

  void link_up(TimePoint now) override;
  void link_down(TimePoint now, std::string_view why) override;
  void receive(std::string_view bytes, TimePoint now) override;
  void advance(TimePoint now) override;
  std::optional<TimePoint> next_deadline() const override;
  const Profile& profile() const override { return profile_; }
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
  std::size_t queued(Lane lane) const override;
  int outstanding_answers() const override { return 0; }  // a late answer is recognised by its old sequence number
  void number_motions_after(MotionId last) override { last_motion_ = last; }
  void wind_down(TimePoint now, OnWoundDown done) override;

 private:
  struct Jog {
    TimePoint renewed{};
    int direction = 1;
    std::int64_t speed = kJogSpeed, sent = 0, fastest = 0;  // pulses/s
    bool ended = false;
    std::optional<Problem> why;  // reason of the end; nullopt: the caller ended it
    std::optional<TimePoint> stop_at;
  };
  struct Live {
    Motion motion;
    RequestContext context;
    OnStarted on_started;
    std::optional<MoveRequest> move;
    bool has_turn = false;
    bool wrote = false;         // the start command may have reached the rotor
    bool in_doubt = false;      // the start command was not answered
    bool found_before = false;  // the origin was already found when an origin return was written
    std::string stopped_by;     // empty: not stopped
    std::optional<Jog> jog;
  };
  struct StopJob {
    std::vector<OnStopped> done;
    StopReport report;
    std::optional<TimePoint> stands_by;  // time limit for the standstill, set when the stop is answered
  };
  using StopJobPtr = std::shared_ptr<StopJob>;

  // controller.cc
  template <class Call>
  void at(TimePoint now, Call call) {
    now_ = now;
    call();
    settle();
  }
  void settle();
  Result<void> allowed(const RequestContext& context, AxisSet axes);
  Result<void> check_epochs(const RequestContext& context) const;
  Result<void> check_home(const HomeRequest& request) const;
  Result<std::int64_t> jog_speed(const std::optional<Quantity>& asked, const RequestContext& context) const;
  tl::unexpected<Problem> cannot(std::string_view why, std::string hint) const;
  Envelope envelope(const RequestContext& context) const { return {profile_, state_, context.who, context.role}; }
  Live* find(MotionId id);
  Live* create(MotionKind kind, const RequestContext& context, OnStarted& started);
  void emit(const Event& event) { events_.on_event(event, now_); }

  // session.cc: the link, readings, stops, the end
  std::optional<Problem> may_write(const Asked& asked) override;
  void wire_open() override;
  void wire_lost(const std::string& why) override;
  void wire_event(const Event& event) override { emit(event); }
  void identified(const Answer& answer);
  void come_up();
  void ask_status(Lane lane, std::string who, std::function<void(const Answer&)> then = {},
                  TimePoint not_after = TimePoint::max());
  void apply_status(std::int32_t payload);
  void tell_foreign_motion(bool busy);
  std::optional<TimePoint> poll_at() const;
  void stop_rotor(AxisSet axes, bool emergency, const std::string& who, OnStopped done);
  void flush_motions(const std::string& who);
  void stop_answered(const StopJobPtr& job, const Answer& answer);
  void finish_stop(const StopJobPtr& job);
  void look_after_stops();
  void carry_out_orders();
  void begin_last_stop();
  bool wind_on();

  // motions.cc
  void expire_waiting();
  bool take_turn();
  void at_turn(MotionId id, const Answer& looked);
  Result<std::int64_t> plan_move(const MoveRequest& request) const;
  Result<std::int32_t> plan_start(Live& live) const;
  void started(MotionId id, const Answer& answer);
  void mark_running(Live& live);
  void end(MotionId id, MotionState outcome, std::optional<Problem> problem);
  void judge();
  void judge_standing(const Live& live);
  void keep_jogs();
  void keep_jog(Live& live);
  void keep_running(Live& live);
  std::optional<Problem> must_end(const Live& live);
  std::optional<TimePoint> stop_before_bound(const Live& live, std::int64_t speed) const;
  void ask_start(Live& live, std::int32_t payload, std::function<void(const Answer&)> done);

  const Profile profile_;
  const int sign_;  // factor from a caller's pulses to the rotor's: 1 or -1
  EventSink& events_;
  Permission& permission_;
  Wire wire_;
  TimePoint now_{};
  bool settling_ = false;
  State state_;
  std::string unit_;           // serial number that has passed a handshake
  bool origin_found_ = false;  // as the rotor reports it
  bool strange_before_ = false;
  bool runaway_ = false;  // a jog was running when the line was lost
  int looking_ = 0;       // number of unanswered status questions
  TimePoint looked_{};
  std::map<MotionId, Live> live_;  // the first motion has its turn, or is next
  std::deque<Motion> ended_;
  MotionId last_motion_ = 0;
  std::list<StopJobPtr> stops_;

  std::optional<Problem> ending_;  // answer to all later requests
  bool last_stop_ = false;         // the end no longer waits for motions
  TimePoint ending_limit_{};
  OnWoundDown on_wound_down_;
  std::vector<MotionId> unfinished_;
  std::shared_ptr<WindDownReport> last_report_;
};

}  // namespace axisgate::rotor
