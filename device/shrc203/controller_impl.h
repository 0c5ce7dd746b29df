// The inside of Controller: what its procedures share. Each procedure is a coroutine in a file of its own:
//
//   handshake.cc  who is there, after a connect         reading.cc       positions, registers, settings
//   move.cc       set, go, watch                        home.cc          origin returns
//   path.cc       the double buffer's chain             stop.cc          L: and L:E
//   execute.cc, execute_request.cc  a caller's lines    watch.cc         a running motion to its outcome
//   wind_down.cc  the end                               jog.cc           axes that run until they are stopped
//   excursion.cc  out of HOST and back                  explain.cc       why NG
//   speeds.cc     what D: has set, for a motion         clear_errors.cc  BEC:
//   lease_settings.cc  what a lease's holder has set    positions.cc     saved positions
//   restore.cc    what is set back later
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "device/core/task.h"
#include "device/shrc203/command/builders.h"
#include "device/shrc203/controller.h"
#include "device/shrc203/limits.h"
#include "device/shrc203/line/line.h"
#include "device/shrc203/motion/motion_gate.h"
#include "device/shrc203/motion/registers.h"
#include "device/shrc203/planning/path_plan.h"
#include "device/shrc203/planning/plan.h"
#include "device/shrc203/planning/scan_plan.h"
#include "device/shrc203/session/pending_restores.h"
#include "device/shrc203/session/switch_audit.h"

namespace axisgate::shrc203 {

// What a jog needs besides.
struct JogKeeping {
  explicit JogKeeping(Executor& executor) : news(executor) {}

  Signal news;  // a renewal, a new speed, its start, its end
  TimePoint renewed{};
  std::uint64_t epoch = 0;              // of the device, when it was asked for
  std::map<int, int> directions;        // by axis
  std::map<int, std::int64_t> speeds;   // asked for, by axis; in pulses/s
  std::map<int, std::int64_t> sent;     // the last that JD: was accepted with
  std::map<int, std::int64_t> fastest;  // that the axis may run at by now
  std::optional<TimePoint> begun;       // its G: may have been written since
  bool ended = false;                   // the gateway stops it, or its caller
  bool stop_pending = false, speed_pending = false;
  std::optional<Problem> why;  // of that; nothing: its caller wanted it
};

// What a scan needs besides.
struct ScanKeeping {
  Trigger trigger;                       // that it runs with
  Trigger before;                        // that there is to be again
  std::optional<std::int64_t> armed_at;  // by the counter that the trigger counts
};

// A motion and what its procedure needs to know of it.
struct LiveMotion {
  LiveMotion(Executor& executor, Motion record, RequestContext from)
      : motion(std::move(record)), context(std::move(from)), news(executor) {}

  Motion motion;
  RequestContext context;
  Signal news;  // a completion of its axes, a stop, the loss of the line
  Controller::OnStarted on_started;
  bool stop_requested = false;
  std::string stopped_by;
  bool woken = false;  // every axis number has come, or a stop
  bool line_lost = false;
  std::string line_problem;
  AxisSet uses;  // what it needs the right to: its axes, or all for a command that concerns the whole controller
  bool inside_gate = false;
  bool watched = false;     // watch() reads the positions
  bool keeps_gate = false;  // past its outcome, until the speeds it changed are the old ones again
  bool needs_excitation = true;
  bool ends_where_it_began = false;  // a whole circle: standing at its target tells nothing
  bool seen_busy = false;
  bool chains = false;     // several segments: its numbers come more than once
  std::int64_t slack = 0;  // pulses by which its end may lie beside its targets (manual 72))
  bool cut_short = false;  // not all of its segments were started: standing at its target is no success
  bool wrote = false;      // a line of its own went out: the registers may hold something

  struct Completion {
    int axis = 0;
    bool doubtful = false;
    TimePoint at{};
  };
  std::deque<Completion> completions;  // not yet looked at by the procedure
  AxisSet completed;                   // axes whose number has come at least once
  std::function<void(int axis)> on_completion;
  std::function<void()> on_success;  // before the outcome is told
  std::optional<JogKeeping> jog;
  std::optional<ScanKeeping> scan;
};
using LiveMotionPtr = std::shared_ptr<LiveMotion>;

struct StopJob {
  AxisSet axes;
  AxisSet stops() const { return emergency ? AxisSet::all() : axes; }
  bool emergency = false;
  bool answered = false;  // its L: has been answered: a later stop is another one
  RequestContext context;
  std::vector<Controller::OnStopped> done;
  StopReport report;
};
using StopJobPtr = std::shared_ptr<StopJob>;

class Controller::Impl : public LineListener {
 public:
  Impl(Profile profile, ByteLink& link, EventSink& events, Permission& permission);
  ~Impl() override;

  // Every call from outside begins with the time and ends by letting the tasks go on.
  template <class Call>
  void at(TimePoint now, Call call) {
    now_ = now;
    call();
    settle();
  }
  void settle();
  std::optional<TimePoint> next_deadline() const;

  void line_opened(TimePoint now) override;
  void line_connected(const Identity& identity, TimePoint now) override;
  void line_trusted(TimePoint now) override;
  void same_controller(TimePoint now) override;
  void line_lost(const std::string& why, TimePoint now) override;
  void barrier_entered(const std::string& why, TimePoint now) override;
  void barrier_passed(const Identity& identity, TimePoint now) override;
  void restart_suspected(TimePoint now) override;
  void completion_seen(int axis, bool doubtful, TimePoint now) override;
  void line_event(const Event& event, TimePoint now) override;
  std::optional<Problem> may_write(const ExchangeRequest& request, TimePoint now) override;
  Task<void> tell_notices(ProgramNotice::Kind kind);
  void note_completion(int axis, bool doubtful, bool deduced, TimePoint now);

  // handshake.cc
  Task<void> handshake(Identity identity, std::uint64_t connection);
  Task<bool> wait_for_host_mode(std::uint64_t connection);
  bool panel_is_wrong() const;
  void note_wrong_panel();
  Problem not_up() const;
  Task<bool> wait_until_all_ready(std::uint64_t connection);
  Task<bool> read_settings(std::uint64_t connection);
  Task<void> poll();
  Task<void> follow_mode();
  Task<void> look_for_restart(std::uint64_t connection);

  // reading.cc
  using Question = commands::Question;
  Task<ExchangeResult> ask(Command command, Lane lane, std::string caller, bool in_handshake = false);
  Task<ExchangeResult> ask(Question question, Lane lane, std::string caller, bool in_handshake = false) {
    return ask(commands::ask(question), lane, std::move(caller), in_handshake);
  }
  // The same answer in a row: one byte that the line lost would make another of it. line_fault.
  Task<Result<Reply>> ask_twice(LiveMotionPtr live, Command question);
  Task<Result<void>> read_positions(Lane lane, std::string caller, bool in_handshake = false);
  Task<Result<void>> read_registers(std::string caller);
  Task<Result<void>> read_speeds(std::string caller);
  Task<Result<void>> read_origin_speeds(std::string caller);
  Task<Result<void>> read_scales(std::string caller);
  Task<Result<void>> read_excitation(std::string caller);
  Task<Result<void>> read_outputs(std::string caller);
  Task<Result<void>> read_trigger(std::string caller);
  Task<void> refresh(Duration max_age, RequestContext context, OnState done);
  AxisSet moving_silently();
  bool apply_positions(const Reply& reply);
  void tell_foreign_motion(AxisSet busy);
  void publish_state();

  // explain.cc
  Task<Problem> explain_refusal(Command command, AxisSet axes, std::string caller);
  Task<std::optional<Problem>> explain_refused_question(Command question, std::string caller);
  Problem values_refused() const;
  Task<std::optional<Problem>> refusal_by_program(Command command, std::string caller);
  Task<std::optional<Problem>> refusal_by_settings(Command command, AxisSet axes, std::string caller);
  Task<std::optional<Problem>> wrong_mode(std::string caller);
  Task<bool> sleeps(std::string caller);
  Problem asleep_problem() const;
  Task<Result<void>> check_excitation(AxisSet axes, std::string caller);

  // watch.cc
  LiveMotionPtr create_motion(MotionKind kind, AxisSet axes, RequestContext context, OnStarted started);
  void set_state(LiveMotion& live, MotionState state);
  void end_motion(LiveMotionPtr live, MotionState outcome, std::optional<Problem> problem);
  void mark_running(LiveMotionPtr live);
  // `prebuffer`: it will set prebuffers, which belong to one motion unless the profile says that each axis has its own.
  Task<Result<void>> enter_gate(LiveMotionPtr live, bool prebuffer);
  void leave_gate(LiveMotion& live);
  Task<Result<void>> prepare(LiveMotionPtr live, Register reg);
  Task<Result<void>> clear_left_overs(LiveMotionPtr live, Register reg);
  Task<void> watch(LiveMotionPtr live, bool start_in_doubt);
  Task<void> wait_for_end(LiveMotionPtr live, TimePoint limit);
  // What watch() has seen so far. READY away from the target counts when two readings agree.
  struct EndCheck {
    TimePoint begun{};
    bool start_in_doubt = false;
    bool ready = false;
    Positions positions{};
  };
  void judge(LiveMotionPtr live, EndCheck& check);
  bool at_targets(const LiveMotion& live) const;
  Positions places_of(const LiveMotion& live) const;
  bool anything_moves() const;

  // speeds.cc
  using Speeds = commands::Speeds;
  void note_speeds(const Speeds& speeds);
  Speeds known_speeds(AxisSet axes) const { return shrc203::known_speeds(state_, axes); }
  Speeds known_origin_speeds(AxisSet axes) const { return shrc203::known_origin_speeds(state_, axes); }
  void note_origin_speeds(int axis, const std::optional<SpeedSetting>& speed);
  bool speeds_known() const;
  void forget_speeds(AxisSet axes);
  // Speeds for axes whose own F is more than the caller may run at; none where all are slow enough.
  Result<MovePlan> slowed_down(AxisSet axes, const Envelope& envelope) const;
  // Sets those; who calls restores the speeds when the motion is over.
  Task<Result<void>> slow_down(LiveMotionPtr live);
  Task<Result<void>> set_speeds(LiveMotionPtr live, MovePlan plan);
  Task<Result<void>> learn_speeds(AxisSet axes, std::string caller);

  // lease_settings.cc, restore.cc
  Task<Result<void>> learn_settings(const std::vector<Command>& commands, std::string caller);
  void remember_settings(const RequestContext& context, const Command& command);
  void note_setting(const Command& command, const ExchangeResult& result);
  Task<bool> restore(PendingRestores what, std::span<const RestoredSetting> order, int tries, ExchangeRequest request);
  Task<bool> restore_one(PendingRestores what, RestoredSetting setting, ExchangeRequest request);
  Task<void> restore_speeds(LiveMotionPtr live, Speeds before);
  Task<void> restore_pending_speeds(AxisSet axes, std::string caller);
  Task<bool> restore_pending_trigger(std::string caller);
  Task<bool> restore_in_turn(EndedLease lease, PendingRestores what);
  Task<void> restore_settings_of(EndedLease lease);
  Task<void> restore_all_settings();

  // move.cc, home.cc
  void move(MoveRequest request, OnStarted started);
  Result<MovePlan> check_move(const MoveRequest& request) const;
  Task<void> run_move(LiveMotionPtr live, MoveRequest request);
  Task<void> set_go_watch(LiveMotionPtr live, MovePlan plan, bool by_prebuffer);
  Task<bool> start_never_came(LiveMotionPtr live, Command setter);
  ExchangeRequest motion_request(const LiveMotion& live, Command command, Lane lane) const;
  Task<Result<Reply>> set_and_confirm(LiveMotionPtr live, Command setter, Lane lane);
  enum class Start { accepted, in_doubt };
  Task<Result<Start>> go(LiveMotionPtr live, AxisSet completes);
  Task<bool> moves_all_the_same(LiveMotionPtr live);
  void home(MotionKind kind, HomeRequest request, OnStarted started);
  Task<void> run_home(LiveMotionPtr live);
  // Of a line that starts by itself, and after which each axis tells its end.
  Task<void> start_and_watch(LiveMotionPtr live, Command start);
  Result<void> check_logical_origin(AxisSet axes, const Envelope& limits) const;

  // positions.cc
  void go_to_position(GoToPositionRequest request, OnStarted started);
  Task<void> run_to_position(LiveMotionPtr live, GoToPositionRequest request);
  Task<Result<void>> find_position(LiveMotionPtr live, GoToPositionRequest request);
  // The coordinates by axis that PIT:GET or PAV:GET tells twice in a row; none where nothing is saved there.
  Task<Result<std::map<int, std::int64_t>>> ask_for_position(LiveMotionPtr live, Command question);

  // path.cc
  void run_path(PathRequest request, OnStarted started);
  Task<void> run_path_motion(LiveMotionPtr live, PathRequest request, Register reg);
  Task<void> follow_path(LiveMotionPtr live, PathPlan plan);
  // As plan_path, and: the line can feed it.
  Result<PathPlan> plan_feasible_path(const PathRequest& request) const;

  // scan.cc
  void scan(ScanRequest request, OnStarted started);
  Task<void> run_scan(LiveMotionPtr live, ScanRequest request);
  Result<ScanPlan> plan_scan(const ScanRequest& request, std::optional<Decimal> scale_pulse) const;
  Task<std::optional<Decimal>> read_scale_pulse(int axis, std::string caller);
  Task<std::optional<std::int64_t>> read_counter(int axis, bool of_scale, std::string caller);
  Task<void> count_triggers(LiveMotionPtr live, bool arming);
  Task<void> disarm(LiveMotionPtr live);

  // approach.cc
  static bool approaches(const MoveRequest& request);
  // Both moves of it, held against the envelope.
  Result<PathPlan> plan_approach(const MoveRequest& request) const;
  Task<void> run_approach(LiveMotionPtr live, MoveRequest request);

  // jog.cc
  MotionId jog(JogRequest request, OnStarted started);
  Result<void> renew_jog(MotionId id, const std::vector<JogRequest::Axis>& speeds);
  void end_jog(LiveMotionPtr live, std::optional<Problem> why);
  Task<void> run_jog(LiveMotionPtr live, JogRequest request);
  Task<void> start_jog(LiveMotionPtr live, MovePlan slower);
  Task<void> keep_jog(LiveMotionPtr live);
  void judge_jog(LiveMotionPtr live);
  Task<void> change_jog_speeds(LiveMotionPtr live);
  std::optional<Problem> must_end(const LiveMotion& live);
  TimePoint next_look(const LiveMotion& live) const;
  std::optional<TimePoint> stop_before_bound(const LiveMotion& live, int axis) const;
  std::optional<TimePoint> stop_before_bound(const LiveMotion& live, int axis, std::int64_t speed) const;
  std::int64_t speed_that_fits(const LiveMotion& live, int axis) const;

  // stop.cc
  void stop(AxisSet axes, bool emergency, const RequestContext& context, OnStopped done);
  Task<void> run_stop(StopJobPtr job);
  Task<void> write_stop(StopJobPtr job);
  bool stop_has_no_use(StopJob& job) const;
  Command stop_command(bool emergency, AxisSet axes) const;
  Task<ExchangeResult> write_stop_line(StopJobPtr job, Command command);
  Duration slowing(AxisSet axes) const;
  Task<void> wait_for_standstill(StopJobPtr job);
  Task<bool> prebuffer_is_empty(StopJobPtr job);
  void flush_motions(AxisSet axes, const RequestContext& context, bool emergency);
  void cancel(MotionId id, const RequestContext& context, OnDone done);

  // execute.cc
  void execute(ExecuteRequest request, OnExecute event);
  Task<void> run_transaction(ExecuteRequest request, std::vector<Command> commands, OnExecute event);
  Result<void> may_wait_for_inputs(std::string_view what) const;  // not_allowed
  void execute_stop(const Command& command, const ExecuteRequest& request, OnExecute event);

  // excursion.cc
  bool edits() const { return away_ == Mode::memory_switches || away_ == Mode::program_edit; }
  Problem away_problem() const;
  void leave_host(MotionId motion);
  // What the item of the line says before any of it is set, and all items before they are left: for the audit.
  Task<Result<void>> read_switches_before(LiveMotionPtr live, SwitchAudit& audit, Command command);
  Task<void> read_switches_left(LiveMotionPtr live, SwitchAudit& audit);
  Task<Result<void>> wait_for_program(LiveMotionPtr live);
  Task<void> come_back(LiveMotionPtr live, bool all, bool switches);
  Task<void> come_back_in_handshake();
  Task<bool> step_to_host(Lane lane, std::string caller, bool in_handshake);
  Task<bool> program_stands(std::string caller);
  Task<bool> wait_for_rest_of_program(LiveMotionPtr live);

  // clear_errors.cc
  Task<void> clear_errors(AxisSet axes, RequestContext context, OnDone done);

  // wind_down.cc
  Task<void> wind_down(OnWoundDown done);
  void stop_at_the_end(bool running_too, std::shared_ptr<WindDownReport> report);
  Task<void> wait_for_rest(TimePoint limit);

  // epoch_passed, where the request was meant for another.
  Result<void> check_epochs(const RequestContext& context) const;
  void frame_shifted(AxisSet axes);
  void stop_runaways();
  // Whether the caller may use these axes now, before anything is queued.
  Result<void> may_use(const RequestContext& context, AxisSet axes);
  void carry_out_orders();

  Envelope envelope(const RequestContext& context) const { return {profile_, state_, context.who, context.role}; }

  // Why the link is not up, as far as anything is decided by it; link_problem has it in words.
  enum class LinkTrouble { none, line, mode, format, motion };
  void note_link_problem(LinkTrouble trouble, std::string words) {
    link_trouble_ = trouble;
    state_.link_problem = std::move(words);
  }
  // The only place that writes State::link: what the line's phase is shown as.
  void show_link() { state_.link = shown(line_.state().phase()); }
  bool line_works() const { return state_.link == LinkState::up || state_.link == LinkState::doubtful; }

  TimePoint default_limit(TimePoint asked, Duration otherwise) const {
    return asked == TimePoint{} ? now_ + otherwise : asked;
  }
  void emit(const Event& event) { events_.on_event(event, now_); }

  Profile profile_;
  EventSink& events_;
  Permission& permission_;
  TimePoint now_{};
  Executor executor_;
  Line line_;
  State state_;
  std::string unit_;        // the serial number that has passed a handshake
  std::string scale_told_;  // what ?:P was answered
  LinkTrouble link_trouble_ = LinkTrouble::none;
  Registers registers_;
  MotionGate gate_;
  std::map<MotionId, LiveMotionPtr> live_;  // without an outcome yet
  PendingRestores pending_restores_;
  std::deque<Motion> ended_;
  MotionId last_motion_ = 0;
  std::uint64_t connection_ = 0;  // counts connects, so that a procedure notices a new one
  std::vector<StopJobPtr> stops_;
  struct NoticeCount {
    std::int64_t untold = 0;
    bool telling = false;
  };
  std::map<ProgramNotice::Kind, NoticeCount> notices_;
  std::optional<Mode> away_;  // a transaction leads out of HOST; where it is by now
  Signal wake_poll_;
  Signal tick_;                    // never notified: to wait for a time
  AxisSet strange_before_;         // moved at the last reading, and nobody had asked for it
  AxisSet runaways_;               // a jog was running there when the line was lost
  bool settled_ = false;           // the last reading was READY and nothing has happened since
  std::optional<Problem> ending_;  // what is told to everybody who comes too late
};

}  // namespace axisgate::shrc203
