// Out of HOST by P:R or MS:ON and back (manual 102) to 126)): while a transaction is away, nobody else is answered, and
// what it has changed is read anew.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "device/core/guard.h"
#include "device/shrc203/controller_impl.h"
#include "device/shrc203/limits.h"

namespace axisgate::shrc203 {
namespace {

// By the second field of ?:L (manual 41)): it runs, or runs one line. Where it pauses it waits for somebody.
bool runs(std::string_view status) { return status == "1" || status == "3"; }

Result<void> program_outcome(const std::vector<std::string>& told) {
  static constexpr std::array<std::string_view, 5> kWhy = {
      "it names axes that are not controllable", "an error occurred", "it came to a line that it cannot run",
      "the motor of one of its axes is off", "one of its axes was BUSY"};
  const auto status = parse_integer(told[1]).value_or(0);
  if (status < 4 || status > 8) return {};
  return fail(Reason::device_error,
              fmt::format("program {} stopped at line {}: {}", told[0], told[2], kWhy[std::size_t(status - 4)]),
              "mend the line (P:SET), or what it met; see `axisctl status`");
}

std::optional<SwitchAudit::Values> values_of(const Reply& reply) {
  return reply.kind == Reply::Kind::data ? std::optional(reply.fields) : std::nullopt;
}

}  // namespace

Problem Controller::Impl::away_problem() const {
  const bool program = away_ == Mode::program || away_ == Mode::program_edit;
  return {.reason = Reason::wrong_mode,
          .message = fmt::format("somebody has the controller in {} mode, where it answers nobody else",
                                 program ? "program" : "memory switch edit"),
          .hint = "try again when it is back in HOST"};
}

// Before the first line of that transaction: what others have asked for is not sent there.
void Controller::Impl::leave_host(MotionId motion) {
  away_ = Mode::host;
  if (!guarded(Guard::away_alone)) return;
  line_.withdraw(
      [motion](const ExchangeRequest& request) {
        return request.lane != Lane::stop && !request.handshake && request.motion != motion;
      },
      away_problem());
}

Task<Result<void>> Controller::Impl::read_switches_before(LiveMotionPtr live, SwitchAudit& audit, Command command) {
  const auto item = SwitchAudit::item_set_by(command);
  if (!item || audit.knows(*item) || !guarded(Guard::switches_audited)) co_return Result<void>();
  const auto told = co_await ask_twice(std::move(live), SwitchAudit::question_of(*item));
  if (!told) co_return tl::unexpected(told.error());
  audit.before(*item, values_of(*told));
  co_return Result<void>();
}

Task<void> Controller::Impl::read_switches_left(LiveMotionPtr live, SwitchAudit& audit) {
  for (const int item : audit.items()) {
    if (away_ != Mode::memory_switches || live->line_lost) co_return;
    const auto told = co_await ask_twice(live, SwitchAudit::question_of(item));
    if (told) audit.after(item, values_of(*told));
  }
}

// A program runs on the controller's own account, and ?:L tells how far it is (manual 41)): axes are READY between its
// lines, too.
Task<Result<void>> Controller::Impl::wait_for_program(LiveMotionPtr live) {
  Problem problem;
  for (int failures = 0; failures < kProgramReadTries;) {
    const auto told = co_await ask(Question::program, Lane::motion, live->context.who);
    if (live->line_lost) break;
    const bool known = told.reply && !told.problem && told.reply->fields.size() > 2;
    if (known && !runs(told.reply->fields[1])) {
      const auto outcome = program_outcome(told.reply->fields);
      const bool stands = co_await wait_for_rest_of_program(live);
      if (live->stop_requested) co_return fail(Reason::stopped, "stopped by " + live->stopped_by);
      if (outcome && !stands) break;
      co_return outcome;
    }
    failures = known ? 0 : failures + 1;
    if (told.problem) problem = *told.problem;
    auto pause = tick_.wait_until(now_ + kProgramPoll);
    co_await pause;
  }
  problem.reason = Reason::outcome_unknown;
  problem.message = "nobody can tell what became of the program: " + problem.message;
  problem.hint = "look at the stage and its positions before moving on";
  co_return tl::unexpected(std::move(problem));
}

// Whether no program runs, as far as can be told.
Task<bool> Controller::Impl::program_stands(std::string caller) {
  const auto told = co_await ask(Question::program, Lane::motion, std::move(caller));
  const bool known = told.reply && !told.problem && told.reply->fields.size() > 2;
  co_return known && !runs(told.reply->fields[1]);
}

// P:E, too, lets the axes slow down.
Task<bool> Controller::Impl::wait_for_rest_of_program(LiveMotionPtr live) {
  for (const TimePoint limit = now_ + kReturnToHostLimit; now_ < limit && !live->line_lost;) {
    const auto read = co_await read_positions(Lane::motion, live->context.who);
    const bool busy = std::ranges::any_of(state_.controllable().list(),
                                          [this](int axis) { return state_.axis(axis).busy.value_or(true); });
    if (read && !busy) co_return true;
    auto pause = tick_.wait_until(now_ + kProgramPoll);
    co_await pause;
  }
  co_return false;
}

// One step on the way back, by what ?:MODE tells; an answer that was lost may have left it elsewhere than expected.
// True when it is in HOST.
Task<bool> Controller::Impl::step_to_host(Lane lane, std::string caller, bool in_handshake) {
  const auto mode = co_await ask(Question::mode, lane, caller, in_handshake);
  const bool known = mode.reply && !mode.problem && mode.reply->kind == Reply::Kind::data;
  if (!known) co_return false;
  state_.mode = mode.reply->text;
  if (state_.mode == "HOST") co_return true;
  if (state_.mode == "HOST,MS") {
    (void)co_await ask(commands::leave_switches(), lane, caller, in_handshake);
  } else if (state_.mode == "HOST,PROGRAM") {
    const bool left = (co_await ask(commands::leave_program_mode(), lane, caller, in_handshake)).accepted();
    const bool edited = !left && (co_await ask(commands::leave_program_edit(), lane, caller, in_handshake)).accepted();
    if (!left && !edited) (void)co_await ask(commands::stop_program(), lane, caller, in_handshake);  // a program pauses
  }
  co_return false;
}

// Whatever became of its lines. What is set may be something else now, and with memory switches whatever is read at
// connecting; a program may have set coordinates anew.
Task<void> Controller::Impl::come_back(LiveMotionPtr live, bool all, bool switches) {
  const bool program = !live->motion.axes.empty();
  bool known = false;
  for (const TimePoint limit = now_ + kReturnToHostLimit; now_ < limit && !live->line_lost && !known;) {
    known = co_await step_to_host(Lane::motion, live->context.who, false);
    if (known) break;
    auto pause = tick_.wait_until(now_ + kProgramPoll);
    co_await pause;
  }
  if (known) {
    away_.reset();
    known = co_await read_settings(connection_);
  }
  registers_.forget();
  if (program) frame_shifted(AxisSet::all());
  for (auto& result : live->motion.results) result.target_pulses = state_.axis(result.axis).position_pulses;
  if (known) {
    std::optional<Problem> stopped;
    if (live->stop_requested) stopped = Problem{.reason = Reason::stopped, .message = "stopped by " + live->stopped_by};
    const MotionState outcome = all ? MotionState::succeeded : MotionState::failed;
    end_motion(live, stopped ? MotionState::stopped : outcome, stopped);
  } else {
    end_motion(live, program ? MotionState::unknown : MotionState::failed,
               Problem{.reason = Reason::outcome_unknown,
                       .message = "the line was lost while the controller was out of HOST: " + live->line_problem,
                       .hint = "look at the positions and settings before moving on"});
  }
  if (!live->line_lost && (switches || !known)) line_.give_up("it was out of HOST, and is looked at anew", now_);
}

// Somebody was cut off there: the handshake takes back what the gateway itself has begun, and ends his program.
Task<void> Controller::Impl::come_back_in_handshake() {
  if (!away_) co_return;
  if (state_.mode == "HOST,PROGRAM") (void)co_await ask(commands::stop_program(), Lane::question, "the gateway", true);
  (void)co_await step_to_host(Lane::question, "the gateway", true);
}

}  // namespace axisgate::shrc203
