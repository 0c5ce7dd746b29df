#include "device/shrc203/session/explainer.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "device/core/guard.h"
#include "device/shrc203/command/command_table.h"
#include "device/shrc203/command/refusals.h"
#include "device/shrc203/limits.h"
#include "device/shrc203/planning/transaction_lines.h"
#include "device/shrc203/session/program_status.h"

namespace axisgate::shrc203 {
namespace {

Problem refusal_of(const Command& command, Problem why) {
  why.message = fmt::format("the controller refused {} (NG): {}", command.line, why.message);
  why.sent = command.line;
  why.wire_reply = "NG";
  return why;
}

Problem asleep_problem() {
  return {.reason = Reason::not_excited,
          .message = "the controller sleeps",
          .hint = "wake it up: `ChangeSettings` with `sleeping` (the stage may move)"};
}

}  // namespace

Task<Problem> Explainer::explain(Command command, AxisSet axes, std::string caller) {
  const auto explained = [&](Problem problem) { return refusal_of(command, std::move(problem)); };
  if (non_host_.edits()) {  // Q: is not answered in these modes
    const auto wrong = co_await wrong_mode(caller);
    co_return explained(wrong ? *wrong : values_refused());
  }
  const auto read = co_await reader_.read_positions(Lane::motion, caller);
  if (!read) {
    const auto wrong = co_await wrong_mode(caller);
    co_return wrong ? explained(*wrong) : unexplained(command.line, axes, store_.state());
  }
  if (non_host_.in_program()) {
    const auto by_program = co_await refusal_by_program(command, caller);
    if (by_program) co_return explained(*by_program);
  }
  (void)co_await reader_.read_excitation(caller);
  if (const auto shown = refusal_by(*command.row, axes, store_.state())) co_return explained(*shown);
  // The manual does not say whether the motion of other axes counts (busy_scope).
  if (command.row->needs.ready && store_.profile().busy_scope == Scope::controller) {
    const auto other = busy_shown(store_.controllable(), store_.state());
    if (other) co_return explained(*other);
  }
  const auto by_setting = co_await refusal_by_settings(command, axes, caller);
  if (by_setting) co_return explained(*by_setting);
  const bool asleep = co_await sleeps(caller);
  if (asleep) co_return explained(asleep_problem());
  const auto wrong = co_await wrong_mode(caller);
  co_return wrong ? explained(*wrong) : unexplained(command.line, axes, store_.state());
}

Task<std::optional<Problem>> Explainer::explain_question(Command question, std::string caller) {
  const auto wrong = co_await wrong_mode(std::move(caller));
  if (wrong) co_return refusal_of(question, *wrong);
  if (non_host_.edits()) co_return refusal_of(question, values_refused());
  co_return std::nullopt;
}

// Returns the only cause that is left in the edit modes, where nothing reports which axes move (manual 111), 117)).
Problem Explainer::values_refused() const {
  if (non_host_.in_switches()) {
    return {.reason = Reason::device_refused,
            .message =
                "it is in memory switch edit mode, so there is no such memory switch, or it does not take that value",
            .hint = "compare number and value with the list of memory switches in \"Preparation and Operation\""};
  }
  return {.reason = Reason::device_refused,
          .message = "it is in program edit mode, so it does not take that step, or something moves",
          .hint = "compare the step with manual 114), and see that nothing moves: `GetDevice`"};
}

// Returns the refusal due to the program's status; nullopt if there is none. Status 1: runs, 2: pauses, 3: runs one
// line (manual 41)).
Task<std::optional<Problem>> Explainer::refusal_by_program(Command command, std::string caller) {
  const auto reported = co_await dialogue_.ask(Dialogue::Question::program, Lane::motion, std::move(caller));
  const auto program = program_status(reported);
  if (!program) co_return std::nullopt;
  const auto status = parse_integer(program->status).value_or(0);
  const bool active = status >= 1 && status <= 3;
  if (command.row->needs.ready && active) {
    co_return Problem{.reason = Reason::axis_busy,
                      .message = fmt::format("program {} {}", program->program, status == 2 ? "pauses" : "runs"),
                      .hint = "wait for its end, or stop it: `Stop`"};
  }
  if (command.row->meaning == Meaning::program_pause && !active) {
    co_return Problem{.reason = Reason::device_refused,
                      .message = "no program runs that could pause",
                      .hint = "let P:S run it; `Stop` ends it"};
  }
  co_return std::nullopt;
}

// Returns the refusal due to settings: S: although the stage sets its own divisions, one speed that does not fit the
// other, or a start with setpoints of two commands.
Task<std::optional<Problem>> Explainer::refusal_by_settings(Command command, AxisSet axes, std::string caller) {
  const Meaning meaning = command.row->meaning;
  if (meaning == Meaning::go) {
    const auto reported = co_await reader_.read_registers(caller);
    const AxisSet both = axes & registers_.clearable() & registers_.lasting();
    if (reported && !both.empty()) co_return stale_setpoint(both);
  }
  if (command.row->rescales) {
    auto configured = co_await refusal_by_stage(axes, caller);
    if (configured) co_return configured;
  }
  if (meaning != Meaning::minimum_speed && meaning != Meaning::maximum_speed) co_return std::nullopt;
  const auto read = co_await reader_.read_speeds(caller);
  if (!read) co_return std::nullopt;
  co_return refusal_by_speeds(command, caller);
}

Task<std::optional<Problem>> Explainer::refusal_by_stage(AxisSet axes, std::string caller) {
  const auto config = co_await dialogue_.ask(Dialogue::Question::auto_config, Lane::motion, std::move(caller));
  const auto reported = config.reply && !config.problem ? by_axis(model(), *config.reply, store_.controllable())
                                                        : std::map<int, std::string>();
  const auto on = [&reported](int axis) { return reported.contains(axis) && reported.at(axis) == "1"; };
  if (!std::ranges::any_of(axes.list(), on)) co_return std::nullopt;
  co_return Problem{.reason = Reason::device_refused,
                    .message = "the axis is configured by its stage (memory switch AXIS-CONFIG), so S: is invalid",
                    .hint = "switch CONFIG off in the memory switches, if the divisions must be others"};
}

std::optional<Problem> Explainer::refusal_by_speeds(const Command& command, const std::string& caller) const {
  const RequestContext nobody{.who = caller};
  for (const auto& [axis, minimum, maximum] : speeds_of(command, store_.controllable())) {
    const auto asked = store_.envelope(nobody).speed(axis, minimum ? *minimum : *maximum);
    const auto known = store_.speeds(AxisSet::of(axis));
    if (!asked || !known.contains(axis)) continue;
    const std::int64_t s = minimum ? *asked : known.at(axis).minimum, f = minimum ? known.at(axis).maximum : *asked;
    if (s <= f) continue;
    return Problem{
        .reason = Reason::out_of_range,
        .message = fmt::format("axis {} would have a minimum speed S of {} above its maximum speed F of {} pulses/s",
                               axis, s, f),
        .hint = "set both at once: `ChangeSettings` with `speeds`",
        .axis = axis};
  }
  return {};
}

// Returns wrong_mode if the mode or the dialect is not the expected one: somebody has changed it at the front panel,
// where Q: is refused too, or it is changed by P:R.
Task<std::optional<Problem>> Explainer::wrong_mode(std::string caller) {
  const Mode mode = non_host_.mode();
  const std::string_view expected_mode = mode == Mode::host              ? "HOST"
                                         : mode == Mode::memory_switches ? "HOST,MS"
                                                                         : "HOST,PROGRAM";
  for (const auto& [question, expected] :
       {std::pair{Dialogue::Question::mode, expected_mode}, {Dialogue::Question::format, "SHOT_FC"}}) {
    const auto reported = co_await dialogue_.ask(question, Lane::question, caller, true);
    const bool known = reported.reply && !reported.problem && reported.reply->kind == Reply::Kind::data;
    if (!known || reported.reply->text == expected) continue;
    co_return Problem{
        .reason = Reason::wrong_mode,
        .message = fmt::format("{} reports {}; {} is needed", commands::text(question), reported.reply->text, expected),
        .hint = "correct it at the controller's front panel"};
  }
  co_return std::nullopt;
}

// Reports whether the controller sleeps. A bare 1 could be an axis number, so this waits until no completion of the
// refused axes is possible, but not until the motion of others has ended.
Task<bool> Explainer::sleeps(std::string caller) {
  if (!line_.completions().possible().empty()) {
    auto quiet = tasks_.pause(kNoCompletionAfterReady);
    co_await quiet;
    (void)co_await reader_.read_positions(Lane::motion, caller);
  }
  ExchangeRequest request;
  request.command = commands::ask(Dialogue::Question::sleep);
  request.lane = Lane::motion;
  request.caller = std::move(caller);
  request.not_after = tasks_.now() + kSleepQuestionLimit;
  auto pending = dialogue_.exchange(std::move(request));
  const auto reported = co_await pending;
  co_return reported.reply && !reported.problem && reported.reply->text == "1";
}

Task<Result<void>> Explainer::check_excitation(AxisSet axes, std::string caller) {
  const auto off = [&] {
    for (const int axis : axes.list()) {
      if (!store_.state().axis(axis).excited.value_or(true)) return axis;
    }
    return 0;
  };
  if (off() == 0 || !guarded(Guard::excitation_known)) co_return Result<void>();
  const auto read = co_await reader_.read_excitation(caller);
  if (!read) co_return read;
  const auto shown = start_refused_by(axes, store_.state());
  if (off() == 0 || !shown) co_return Result<void>();
  co_return tl::unexpected(*shown);
}

}  // namespace axisgate::shrc203
