// Moves: set, go, watch. Set and go are one step; nothing is ever sent twice that could move the stage.
#include <fmt/format.h>

#include <algorithm>

#include "device/core/guard.h"
#include "device/shrc203/controller_impl.h"
#include "device/shrc203/limits.h"

namespace axisgate::shrc203 {
namespace {

bool any_speed(const MovePlan& plan) {
  for (const auto& axis : plan.axes) {
    if (axis.speed) return true;
  }
  return false;
}

// MP: and AP: take the speeds of all their axes or of none (manual 68), 70)).
Command prebuffer_setter(const MovePlan& plan, const State& state) {
  auto speeds = speeds_of(plan);
  if (!speeds.empty()) {
    for (const auto& axis : plan.axes) {
      const auto& known = state.axis(axis.axis);
      speeds.try_emplace(axis.axis, SpeedSetting{known.minimum_speed.value_or(1), known.maximum_speed.value_or(1),
                                                 known.acceleration_ms.value_or(1)});
    }
  }
  return commands::set_setpoint(plan.relative ? Register::mp : Register::ap, amounts_of(plan), speeds);
}

Command execution_setter(const MovePlan& plan) {
  return commands::set_setpoint(plan.relative ? Register::m : Register::a, amounts_of(plan));
}

}  // namespace

// Where something moves, places are known at the motion's turn.
Result<MovePlan> Controller::Impl::check_move(const MoveRequest& request) const {
  const bool standing = !anything_moves();
  if (approaches(request) && standing) {
    if (const auto both = plan_approach(request); !both) return tl::unexpected(both.error());
  }
  return plan_move(request.moves, request.relative, standing ? positions_of(state_) : Positions{},
                   envelope(request.context));
}

void Controller::Impl::move(MoveRequest request, OnStarted started) {
  const auto plan = check_move(request);
  if (!plan) {
    started(tl::unexpected(plan.error()));
    return;
  }
  if (const auto allowed = may_use(request.context, plan->set()); !allowed) {
    started(tl::unexpected(allowed.error()));
    return;
  }
  auto live = create_motion(MotionKind::move, plan->set(), request.context, std::move(started));
  if (approaches(request)) return executor_.spawn(run_approach(live, std::move(request)));
  executor_.spawn(run_move(live, std::move(request)));
}

Task<void> Controller::Impl::run_move(LiveMotionPtr live, MoveRequest request) {
  const auto entered = co_await enter_gate(live, false);
  if (!entered) {
    end_motion(live, entered.error().reason == Reason::stopped ? MotionState::stopped : MotionState::failed,
               entered.error());
    co_return;
  }
  const bool others_run = gate_.others_inside(live->motion.id);
  const bool by_prebuffer =
      !others_run || profile_.prebuffer_scope == Scope::axis || !guarded(Guard::prebuffers_are_one_motions);
  const Register reg =
      by_prebuffer ? (request.relative ? Register::mp : Register::ap) : (request.relative ? Register::m : Register::a);
  const auto ready = co_await prepare(live, reg);
  if (!ready) {
    end_motion(live, ready.error().reason == Reason::stopped ? MotionState::stopped : MotionState::failed,
               ready.error());
    co_return;
  }
  const auto plan = plan_move(request.moves, request.relative, positions_of(state_), envelope(request.context));
  if (!plan) {
    end_motion(live, MotionState::failed, plan.error());
    co_return;
  }
  for (std::size_t i = 0; i < plan->axes.size(); ++i) {
    const AxisPlan& one = plan->axes[i];
    live->motion.results[i].target_pulses = one.target;
    if (one.target) continue;
    end_motion(live, MotionState::failed,
               Problem{.reason = Reason::position_unknown,
                       .message = fmt::format("where axis {} stands is not known", one.axis),
                       .hint = "wait until the device is up",
                       .axis = one.axis});
    co_return;
  }
  const Speeds before = known_speeds(plan->set());
  live->keeps_gate = any_speed(*plan);
  co_await set_go_watch(live, *plan, by_prebuffer);
  co_await restore_speeds(live, before);
}

Task<void> Controller::Impl::set_go_watch(LiveMotionPtr live, MovePlan plan, bool by_prebuffer) {
  if (!by_prebuffer && any_speed(plan)) {
    const auto speeds = co_await set_speeds(live, plan);
    if (!speeds) {
      end_motion(live, MotionState::failed, speeds.error());
      co_return;
    }
  }
  auto setter = by_prebuffer ? prebuffer_setter(plan, state_) : execution_setter(plan);
  const auto set = co_await set_and_confirm(live, setter, Lane::motion);
  if (!set) {
    end_motion(live, live->stop_requested ? MotionState::stopped : MotionState::failed, set.error());
    co_return;
  }
  note_speeds(speeds_of(plan));
  const auto start = co_await go(live, by_prebuffer ? live->motion.axes : AxisSet());
  if (!start) {
    end_motion(live, live->stop_requested ? MotionState::stopped : MotionState::failed, start.error());
    co_return;
  }
  const bool in_doubt = *start == Start::in_doubt;
  if (in_doubt && co_await start_never_came(live, setter)) {
    end_motion(live, live->stop_requested ? MotionState::stopped : MotionState::failed,
               Problem{.reason = Reason::not_sent,
                       .message = "the start did not reach the controller: nothing moved",
                       .hint = "try again",
                       .sent = std::string(commands::go(live->motion.axes).row->name)});
    co_return;
  }
  co_await watch(live, in_doubt);
}

// A start that arrived has taken the setting out of its register. True only when it is certain that none did.
Task<bool> Controller::Impl::start_never_came(LiveMotionPtr live, Command setter) {
  if (!guarded(Guard::not_sent_is_proved)) co_return true;
  const Positions before = positions_of(state_);
  auto pause = tick_.wait_until(now_ + kStartVisibleWithin);
  co_await pause;
  const auto answer = co_await ask(commands::question_of(setter.row->reg), Lane::motion, live->context.who);
  if (!answer.reply || answer.problem || answer.reply->kind != Reply::Kind::data) co_return false;
  if (held(*answer.reply, setter, state_.controllable()) != Held::as_set) co_return false;
  const auto read = co_await read_positions(Lane::motion, live->context.who);
  if (!read || live->line_lost) co_return false;
  bool stands = true;
  for (const int axis : live->motion.axes.list()) {
    const auto place = static_cast<std::size_t>(axis - 1);
    stands = stands && !state_.axis(axis).busy.value_or(true) && state_.axis(axis).position_pulses == before[place];
  }
  co_return stands;
}

ExchangeRequest Controller::Impl::motion_request(const LiveMotion& live, Command command, Lane lane) const {
  ExchangeRequest request;
  request.command = std::move(command);
  request.lane = lane;
  request.caller = live.context.who;
  request.not_after = live.motion.state == MotionState::queued ? live.context.not_after : now_ + kStepWriteLimit;
  request.motion = live.motion.id;
  return request;
}

// A set starts nothing, so one whose answer was lost is looked up, and sent again when it did not arrive.
Task<Result<Reply>> Controller::Impl::set_and_confirm(LiveMotionPtr live, Command setter, Lane lane) {
  Problem problem;
  for (int attempt = 0; attempt < kSetpointTries; ++attempt) {
    if (live->stop_requested && guarded(Guard::stop_before_set)) {
      co_return fail(Reason::stopped, "stopped by " + live->stopped_by);
    }
    live->wrote = true;
    auto pending = line_.exchange(motion_request(*live, setter, lane), now_);
    const auto result = co_await pending;
    if (result.accepted()) co_return *result.reply;
    if (result.refused()) {
      auto why = co_await explain_refusal(setter, live->motion.axes, live->context.who);
      co_return tl::unexpected(std::move(why));
    }
    if (!result.in_doubt() || live->line_lost) co_return tl::unexpected(*result.problem);
    problem = *result.problem;
    if (!guarded(Guard::set_read_back)) continue;
    const auto question = commands::question_of(setter.row->reg);
    const auto answer = co_await ask(question, lane, live->context.who);
    if (!answer.reply || answer.problem || answer.reply->kind != Reply::Kind::data) continue;
    const Held found = held(*answer.reply, setter, state_.controllable());
    if (found == Held::as_set) co_return Reply{Reply::Kind::ok, "OK", {}};
    if (found == Held::other) {
      co_return fail(Reason::line_fault, fmt::format("{} was received wrongly and nothing was started", setter.line),
                     "check the cable and the line settings");
    }
  }
  co_return tl::unexpected(std::move(problem));
}

// The axes stood before the start, so an NG over axes that move was not the controller's.
Task<bool> Controller::Impl::moves_all_the_same(LiveMotionPtr live) {
  const Positions before = positions_of(state_);
  const auto read = co_await read_positions(Lane::motion, live->context.who);
  if (!read) co_return true;
  bool moves = false;
  for (const int axis : live->motion.axes.list()) {
    const auto place = static_cast<std::size_t>(axis - 1);
    moves = moves || state_.axis(axis).busy.value_or(true) || state_.axis(axis).position_pulses != before[place];
  }
  co_return moves;
}

// `completes` are the axes whose numbers will come. Sent once, whatever becomes of its answer.
Task<Result<Controller::Impl::Start>> Controller::Impl::go(LiveMotionPtr live, AxisSet completes) {
  if (live->stop_requested && guarded(Guard::stop_before_go)) {
    co_return fail(Reason::stopped, "stopped by " + live->stopped_by);
  }
  auto request = motion_request(*live, commands::go(live->motion.axes), Lane::motion);
  request.completes = completes;
  live->completed = {};
  live->completions.clear();
  auto pending = line_.exchange(std::move(request), now_);
  const auto result = co_await pending;
  if (result.accepted()) {
    mark_running(live);
    co_return Start::accepted;
  }
  if (result.refused()) {
    const bool moves = guarded(Guard::refused_start_looked_at) && co_await moves_all_the_same(live);
    if (moves) co_return Start::in_doubt;
    auto why = co_await explain_refusal(commands::go(live->motion.axes), live->motion.axes, live->context.who);
    co_return tl::unexpected(std::move(why));
  }
  if (result.in_doubt()) co_return Start::in_doubt;
  co_return tl::unexpected(*result.problem);
}

}  // namespace axisgate::shrc203
