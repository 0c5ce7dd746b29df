// Out of HOST by P:R or MS:ON and back (manual 102) to 126)): while a transaction is away, nobody else is answered, and
// what it has changed is read anew.
#include <fmt/format.h>

#include <array>
#include <vector>

#include "device/core/guard.h"
#include "device/shrc203/controller_impl.h"

namespace axisgate::shrc203 {
namespace {

constexpr Duration kProgramPoll = std::chrono::milliseconds(100);
constexpr int kReturnTries = 5;

std::string_view way_back(Mode mode) {
  if (mode == Mode::memory_switches) return "MS:OFF";
  return mode == Mode::program_edit ? "P:OFF" : "P:H";
}

// By the second field of ?:L (manual 41)): it runs, pauses, or runs one line.
bool runs(std::string_view status) { return status == "1" || status == "2" || status == "3"; }

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

Mode after(std::string_view line) { return line == "P:OFF" ? Mode::program : Mode::host; }

}  // namespace

Problem Controller::Impl::away_problem() const {
  const bool program = away_ == Mode::program || away_ == Mode::program_edit;
  return {Reason::wrong_mode,
          fmt::format("somebody has the controller in {} mode, where it answers nobody else",
                      program ? "program" : "memory switch edit"),
          "try again when it is back in HOST",
          {},
          {},
          {}};
}

// Before the first line of that transaction: what others have asked for is not sent there.
void Controller::Impl::leave_host(MotionId motion) {
  away_ = Mode::host;
  if (!guarded(Guard::away_alone)) return;
  line_.withdraw(
      [motion](const ExchangeRequest& request) { return request.lane != Lane::stop && request.motion != motion; },
      away_problem());
}

// A program runs on the controller's own account, and ?:L tells how far it is (manual 41)): axes are READY between its
// lines, too.
Task<Result<void>> Controller::Impl::wait_for_program(LiveMotionPtr live) {
  Problem problem;
  for (int failures = 0; failures < kReturnTries;) {
    const auto told = co_await ask("?:L", Lane::motion, live->context.who);
    if (live->line_lost) break;
    const bool known = told.reply && !told.problem && told.reply->fields.size() > 2;
    if (known && !runs(told.reply->fields[1])) co_return program_outcome(told.reply->fields);
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

// Whatever became of its lines. What is set may be something else now, and with memory switches whatever is read at
// connecting.
Task<void> Controller::Impl::come_back(LiveMotionPtr live, bool all, bool switches) {
  for (int attempt = 0; attempt < kReturnTries && away_ && *away_ != Mode::host && !live->line_lost; ++attempt) {
    const auto back = way_back(*away_);
    const auto result = co_await ask(back, Lane::motion, live->context.who);
    if (result.accepted()) away_ = after(back);
    if (result.accepted()) continue;
    auto pause = tick_.wait_until(now_ + kProgramPoll);
    co_await pause;
  }
  const bool lost = live->line_lost;
  bool known = false;
  if (!lost && away_ == Mode::host) {
    away_.reset();
    known = co_await read_settings(connection_);
  }
  for (auto& result : live->motion.results) result.target_pulses = state_.axis(result.axis).position_pulses;
  if (lost || !known) {
    const bool moved = !live->motion.axes.empty();
    end_motion(live, moved ? MotionState::unknown : MotionState::failed,
               Problem{Reason::outcome_unknown,
                       "the line was lost while the controller was out of HOST: " + live->line_problem,
                       "look at the positions and settings before moving on",
                       {},
                       {},
                       {}});
  } else {
    end_motion(live,
               live->stop_requested ? MotionState::stopped
               : all                ? MotionState::succeeded
                                    : MotionState::failed,
               {});
  }
  if (!lost && (switches || !known)) line_.give_up("it was out of HOST, and is looked at anew", now_);
}

// Somebody was cut off there: the handshake takes back what the gateway itself has begun.
Task<void> Controller::Impl::come_back_in_handshake() {
  const bool ours = away_ && (state_.mode == "HOST,MS" || state_.mode == "HOST,PROGRAM");
  if (!ours) co_return;
  const Mode there = state_.mode == "HOST,MS" ? Mode::memory_switches : *away_;
  const auto back = way_back(there == Mode::host ? Mode::program : there);
  const auto result = co_await ask(back, Lane::question, "the gateway", true);
  if (result.accepted()) away_ = after(back);
}

}  // namespace axisgate::shrc203
