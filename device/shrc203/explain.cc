// What is asked of the controller after NG, until something tells why; and before a motion, where it is known already.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "device/core/guard.h"
#include "device/shrc203/controller_impl.h"
#include "device/shrc203/refusals.h"

namespace axisgate::shrc203 {

// Each in turn, and the first that tells ends it.
Task<Problem> Controller::Impl::explain_refusal(Command command, AxisSet axes, std::string caller) {
  const auto explained = [&](Problem problem) {
    problem.message = fmt::format("the controller refused {} (NG): {}", command.line, problem.message);
    problem.sent = command.line;
    problem.wire_reply = "NG";
    return problem;
  };
  if (away_ && *away_ != Mode::host) co_return unexplained(command.line, {}, state_);  // no Q: is answered there
  const auto read = co_await read_positions(Lane::motion, caller);
  if (!read) {
    const auto wrong = co_await wrong_mode(caller);
    co_return wrong ? explained(*wrong) : unexplained(command.line, axes, state_);
  }
  (void)co_await read_excitation(caller);
  if (const auto shown = refusal_by(*command.row, axes, state_)) co_return explained(*shown);
  // Whether other axes' motion counts is an open question (busy_scope).
  if (command.row->needs.ready && profile_.busy_scope == Scope::controller) {
    const auto other = refusal_by(command_row("W:"), state_.controllable(), state_);
    if (other) co_return explained(*other);
  }
  if (command.row->rescales) {
    const auto config = co_await ask("?:ACS", Lane::motion, caller);
    const auto told =
        config.reply && !config.problem ? by_axis(*config.reply, state_.controllable()) : std::map<int, std::string>();
    const auto on = [&told](int axis) { return told.contains(axis) && told.at(axis) == "1"; };
    if (std::ranges::any_of(axes.list(), on)) {
      co_return explained({Reason::device_refused,
                           "the axis is configured by its stage (memory switch AXIS-CONFIG), so S: is invalid",
                           "switch CONFIG off in the memory switches, if the divisions must be others",
                           {},
                           {},
                           {}});
    }
  }
  const bool asleep = co_await sleeps(caller);
  if (asleep) co_return explained(asleep_problem());
  co_return unexplained(command.line, axes, state_);
}

// Somebody has changed the mode or the dialect at the front panel, where Q: is refused too.
Task<std::optional<Problem>> Controller::Impl::wrong_mode(std::string caller) {
  for (const auto& [question, expected] : {std::pair{"?:MODE", "HOST"}, {"?:FMT", "SHOT_FC"}}) {
    const auto told = co_await ask(question, Lane::question, caller, true);
    const bool known = told.reply && !told.problem && told.reply->kind == Reply::Kind::data;
    if (!known || told.reply->text == expected) continue;
    co_return Problem{Reason::wrong_mode,
                      fmt::format("{} tells {}; {} is needed", question, told.reply->text, expected),
                      "put it right at the controller's front panel",
                      {},
                      {},
                      {}};
  }
  co_return std::nullopt;
}

// A bare 1 could be an axis number, so this is asked only where none may come.
Task<bool> Controller::Impl::sleeps(std::string caller) {
  if (!line_.completions().possible().empty()) co_return false;
  const auto told = co_await ask("?:SLEEP", Lane::motion, std::move(caller));
  co_return told.reply && !told.problem && told.reply->text == "1";
}

Problem Controller::Impl::asleep_problem() const {
  return {Reason::not_excited, "the controller sleeps", "wake it up: axisctl wake (the stage may move)", {}, {}, {}};
}

// What is known to stand against a motion, asked anew: somebody may have seen to it at the device.
Task<Result<void>> Controller::Impl::check_excitation(AxisSet axes, std::string caller) {
  const auto off = [&] {
    for (const int axis : axes.list()) {
      if (!state_.axis(axis).excited.value_or(true)) return axis;
    }
    return 0;
  };
  if (off() == 0 || !guarded(Guard::excitation_known)) co_return Result<void>();
  const auto read = co_await read_excitation(caller);
  if (!read) co_return read;
  const auto shown = refusal_by(command_row("G:"), axes, state_);
  if (off() == 0 || !shown) co_return Result<void>();
  co_return tl::unexpected(*shown);
}

}  // namespace axisgate::shrc203
