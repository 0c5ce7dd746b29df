#include "device/shrc203/motion/starter.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "device/core/guard.h"
#include "device/shrc203/limits.h"
#include "device/shrc203/session/answers.h"

namespace axisgate::shrc203 {

// Reports whether an axis moves, or has another position than before.
bool Starter::anything_changed(const LiveMotion& live, const Positions& before) const {
  return std::ranges::any_of(live.motion.axes.list(), [&](int axis) {
    const AxisState& state = store_.state().axis(axis);
    return state.busy.value_or(true) || state.position_pulses != before[static_cast<std::size_t>(axis - 1)];
  });
}

Task<bool> Starter::start_never_came(LiveMotionPtr live, Command setter) {
  if (!guarded(Guard::not_sent_is_proved)) co_return true;
  const Positions before = store_.positions();
  auto pause = tasks_.pause(kStartVisibleWithin);
  co_await pause;
  const auto found = co_await read_back(live, setter, Lane::motion);
  if (found != Held::as_set) co_return false;
  const auto read = co_await reader_.read_positions(Lane::motion, live->context.who);
  if (!read || live->life.line_lost()) co_return false;
  co_return !anything_changed(*live, before);
}

Problem Starter::never_came(const LiveMotion& live) {
  return {.reason = Reason::not_sent,
          .message = "the start did not reach the controller: nothing moved",
          .hint = "try again",
          .sent = std::string(commands::go(live.motion.axes).row->name)};
}

// Compares the content of the setter's register with the setter; nullopt if it could not be read.
Task<std::optional<Held>> Starter::read_back(LiveMotionPtr live, Command setter, Lane lane) {
  const auto answer = co_await dialogue_.ask(commands::question_of(setter.row->reg), lane, live->context.who);
  if (!is_data(answer)) co_return std::nullopt;
  co_return held(*answer.reply, setter, store_.controllable());
}

Task<Result<Reply>> Starter::set_and_confirm(LiveMotionPtr live, Command setter, Lane lane) {
  Problem problem;
  for (int attempt = 0; attempt < kSetpointTries; ++attempt) {
    if (live->life.stop_asked() && guarded(Guard::stop_before_set)) co_return tl::unexpected(stopped_by(*live));
    motions_.written(*live);
    auto pending = dialogue_.exchange(dialogue_.request_of(*live, setter, lane));
    const auto result = co_await pending;
    if (result.accepted()) co_return *result.reply;
    if (result.refused()) {
      auto why = co_await explainer_.explain(setter, live->motion.axes, live->context.who);
      co_return tl::unexpected(std::move(why));
    }
    if (!result.in_doubt() || live->life.line_lost()) co_return tl::unexpected(*result.problem);
    problem = *result.problem;
    if (!guarded(Guard::set_read_back)) continue;
    const auto found = co_await read_back(live, setter, lane);
    if (found == Held::as_set) co_return Reply{Reply::Kind::ok, "OK", {}};
    if (found == Held::other) {
      co_return fail(Reason::line_fault, fmt::format("{} was received wrongly and nothing was started", setter.line),
                     "check the cable and the line settings");
    }
  }
  co_return tl::unexpected(std::move(problem));
}

// Reports whether the axes move although the start was refused: they were stationary before, so the NG was not the
// controller's reply to it.
Task<bool> Starter::moves_despite_ng(LiveMotionPtr live) {
  const Positions before = store_.positions();
  const auto read = co_await reader_.read_positions(Lane::motion, live->context.who);
  co_return !read || anything_changed(*live, before);
}

// Sends G: once, whatever becomes of its reply.
Task<Result<Start>> Starter::go(LiveMotionPtr live, AxisSet completes) {
  if (live->life.stop_asked() && guarded(Guard::stop_before_go)) co_return tl::unexpected(stopped_by(*live));
  const Command command = commands::go(live->motion.axes);
  auto request = dialogue_.request_of(*live, command, Lane::motion);
  request.completes = completes;
  live->completed = {};
  live->completions.clear();
  auto pending = dialogue_.exchange(std::move(request));
  const auto result = co_await pending;
  if (result.accepted()) {
    motions_.started(*live);
    co_return Start::accepted;
  }
  if (result.refused()) {
    const bool moves = guarded(Guard::refused_start_looked_at) && co_await moves_despite_ng(live);
    if (moves) co_return Start::in_doubt;
    auto why = co_await explainer_.explain(command, live->motion.axes, live->context.who);
    co_return tl::unexpected(std::move(why));
  }
  if (result.in_doubt()) co_return Start::in_doubt;
  co_return tl::unexpected(*result.problem);
}

Task<std::optional<Start>> Starter::start(LiveMotionPtr live, Command command) {
  if (live->life.stop_asked() && guarded(Guard::stop_before_preparing)) {
    motions_.end(*live, MotionState::stopped, stopped_by(*live));
    co_return std::nullopt;
  }
  auto request = dialogue_.request_of(*live, command, Lane::motion);
  request.completes = live->motion.axes;
  motions_.written(*live);
  auto pending = dialogue_.exchange(std::move(request));
  const auto result = co_await pending;
  if (result.accepted()) {
    motions_.started(*live);
    co_return Start::accepted;
  }
  bool in_doubt = result.in_doubt();
  if (result.refused() && guarded(Guard::refused_start_looked_at)) in_doubt = co_await moves_despite_ng(live);
  if (in_doubt) co_return Start::in_doubt;
  if (result.refused()) {
    const auto why = co_await explainer_.explain(command, live->motion.axes, live->context.who);
    motions_.end(*live, MotionState::failed, why);
  } else {
    motions_.disconnect(*live, *result.problem);
  }
  co_return std::nullopt;
}

}  // namespace axisgate::shrc203
