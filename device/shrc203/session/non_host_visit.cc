#include "device/shrc203/session/non_host_visit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "device/core/guard.h"
#include "device/shrc203/limits.h"
#include "device/shrc203/session/answers.h"
#include "device/shrc203/session/program_status.h"

namespace axisgate::shrc203 {
namespace {

Result<void> program_outcome(const ProgramStatus& reported) {
  static constexpr std::array<std::string_view, 5> kWhy = {
      "it names axes that are not controllable", "an error occurred", "it reached a line that it cannot run",
      "the motor of one of its axes is off", "one of its axes was BUSY"};
  const auto status = parse_integer(reported.status).value_or(0);
  if (status < 4 || status > 8) return {};
  return fail(
      Reason::device_error,
      fmt::format("program {} stopped at line {}: {}", reported.program, reported.line, kWhy[std::size_t(status - 4)]),
      "correct the line (P:SET), or remove what it met; see `GetDevice`");
}

std::optional<SwitchAudit::Values> values_of(const Reply& reply) {
  return reply.kind == Reply::Kind::data ? std::optional(reply.fields) : std::nullopt;
}

}  // namespace

void NonHostVisit::leave_host(MotionId motion) {
  non_host_.began();
  if (!guarded(Guard::non_host_alone)) return;
  line_.withdraw(
      [motion](const ExchangeRequest& request) {
        return request.lane != Lane::stop && !request.handshake && request.motion != motion;
      },
      non_host_.problem());
}

Task<Result<void>> NonHostVisit::read_switches_before(LiveMotionPtr live, SwitchAudit& audit, Command command) {
  const auto item = SwitchAudit::item_set_by(command);
  if (!item || audit.knows(*item) || !guarded(Guard::switches_audited)) co_return Result<void>();
  const auto reported = co_await dialogue_.ask_twice(std::move(live), SwitchAudit::question_of(*item));
  if (!reported) co_return tl::unexpected(reported.error());
  audit.before(*item, values_of(*reported));
  co_return Result<void>();
}

Task<void> NonHostVisit::read_switches_left(LiveMotionPtr live, SwitchAudit& audit) {
  for (const int item : audit.items()) {
    if (!non_host_.in_switches() || live->life.line_lost()) co_return;
    const auto reported = co_await dialogue_.ask_twice(live, SwitchAudit::question_of(item));
    if (reported) audit.after(item, values_of(*reported));
  }
}

// Waits for ?:L to report the end of the program (manual 41)). The program runs independently of the gateway, and axes
// are READY between its lines, too.
Task<Result<void>> NonHostVisit::wait_for_program(LiveMotionPtr live) {
  Problem problem;
  for (int failures = 0; failures < kProgramReadTries;) {
    const auto reported = co_await dialogue_.ask(Dialogue::Question::program, Lane::motion, live->context.who);
    if (live->life.line_lost()) break;
    const auto program = program_status(reported);
    if (program && !program->runs()) {
      const auto outcome = program_outcome(*program);
      const bool stationary = co_await wait_for_axes(live);
      if (live->life.stop_asked()) co_return tl::unexpected(stopped_by(*live));
      if (outcome && !stationary) break;
      co_return outcome;
    }
    failures = program ? 0 : failures + 1;
    if (reported.problem) problem = *reported.problem;
    auto pause = tasks_.pause(kProgramPoll);
    co_await pause;
  }
  problem.reason = Reason::outcome_unknown;
  problem.message = "the outcome of the program is unknown: " + problem.message;
  problem.hint = "check the stage and its positions before the next motion";
  co_return tl::unexpected(std::move(problem));
}

// Waits until the axes are stationary: they also slow down after P:E.
Task<bool> NonHostVisit::wait_for_axes(LiveMotionPtr live) {
  for (const TimePoint limit = tasks_.now() + kReturnToHostLimit; tasks_.now() < limit && !live->life.line_lost();) {
    const auto read = co_await reader_.read_positions(Lane::motion, live->context.who);
    const bool busy = std::ranges::any_of(store_.controllable().list(),
                                          [this](int axis) { return store_.state().axis(axis).busy.value_or(true); });
    if (read && !busy) co_return true;
    auto pause = tasks_.pause(kProgramPoll);
    co_await pause;
  }
  co_return false;
}

Task<bool> step_to_host(Dialogue& dialogue, StateStore& store, Lane lane, std::string caller, bool in_handshake) {
  const auto mode = co_await dialogue.ask(Dialogue::Question::mode, lane, caller, in_handshake);
  if (!is_data(mode)) co_return false;
  store.note_mode(mode.reply->text);
  if (store.state().mode == "HOST") co_return true;
  if (store.state().mode == "HOST,MS") {
    (void)co_await dialogue.ask(commands::leave_switches(), lane, caller, in_handshake);
  } else if (store.state().mode == "HOST,PROGRAM") {
    const auto left = co_await dialogue.ask(commands::leave_program_mode(), lane, caller, in_handshake);
    if (left.accepted()) co_return false;
    const auto edited = co_await dialogue.ask(commands::leave_program_edit(), lane, caller, in_handshake);
    if (edited.accepted()) co_return false;
    (void)co_await dialogue.ask(commands::stop_program(), lane, caller, in_handshake);  // for a program that pauses
  }
  co_return false;
}

Task<bool> NonHostVisit::wait_for_host(LiveMotionPtr live) {
  for (const TimePoint limit = tasks_.now() + kReturnToHostLimit; tasks_.now() < limit && !live->life.line_lost();) {
    const bool host = co_await step_to_host(dialogue_, store_, Lane::motion, live->context.who, false);
    if (host) co_return true;
    auto pause = tasks_.pause(kProgramPoll);
    co_await pause;
  }
  co_return false;
}

// Settings may have changed, with memory switches even everything that is read after a connect. A program may have set
// new coordinates.
Task<void> NonHostVisit::come_back(LiveMotionPtr live, Course course) {
  const bool program = !live->motion.axes.empty();
  bool known = co_await wait_for_host(live);
  if (known) {
    non_host_.returned();
    known = co_await settings_.read(store_.connection());
  }
  registers_.forget();
  if (program) store_.shift_frame(kAllAxes);
  for (auto& result : live->motion.results) {
    result.target_pulses = store_.state().axis(result.axis).position_pulses;
  }
  end(*live, known, course.sent_all);
  if (!live->life.line_lost() && (course.set_switches || !known)) {
    line_.disconnect("it was out of HOST, and is read again", tasks_.now());
  }
}

void NonHostVisit::end(LiveMotion& live, bool known, bool sent_all) {
  if (known && live.life.stop_asked()) {
    motions_.end(live, MotionState::stopped, stopped_by(live));
  } else if (known) {
    motions_.end(live, sent_all ? MotionState::succeeded : MotionState::failed, {});
  } else {
    motions_.end(
        live, live.motion.axes.empty() ? MotionState::failed : MotionState::unknown,
        Problem{.reason = Reason::outcome_unknown,
                .message = "the line was lost while the controller was out of HOST: " + live.life.line_problem(),
                .hint = "check the positions and settings before the next motion"});
  }
}

}  // namespace axisgate::shrc203
