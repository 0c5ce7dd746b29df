// What follows a missing or unreadable reply: nothing else is sent before it is certain again which command an answer
// belongs to.
//
//   ?:CMD    its answer equal to the line in doubt means that the controller received it, not that it accepted it
//   *IDN?    the configured controller is there, and every answer before this one has been given. One damaged byte
//            makes another controller of it, so an answer of another controller counts only when it comes twice
//   silence  completions excepted, for 50 ms, the time of three longest lines, or twice what the identity took: a slow
//            controller may still have other answers to give
//
// A probe without an answer is repeated, three in all. The answer to each unanswered probe is outstanding: it may still
// come, and is discarded wherever it appears.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "device/core/time.h"
#include "device/shrc203/command/reply.h"

namespace axisgate::shrc203 {

// Answers to abandoned probes: they may come at any later time.
struct OutstandingAnswers {
  int echoes = 0;
  int identities = 0;
};

class Barrier {
 public:
  struct Limits {
    Duration reply;  // for a probe's answer
    Duration silence;
  };

  // `line_in_doubt` is empty after a connect, and ?:CMD is then not asked; kAnyLine after a connect that begins with
  // it: if the controller does not answer ?:CMD, the barrier asks for its identity nevertheless. `is_known`: that of
  // the controller that is expected. `write` sends one line.
  static constexpr std::string_view kAnyLine = "?";
  Barrier(std::string line_in_doubt, Limits limits, OutstandingAnswers& outstanding,
          std::function<bool(const Identity&)> is_known, std::function<void(std::string_view)> write);

  void start(TimePoint now);
  // A Stop was written in between: begin again.
  void restart(TimePoint now);

  // A complete line that is no completion. False: nothing waited for it.
  bool on_line(std::string_view line, TimePoint now);
  // Part of a line came.
  void on_half_line(TimePoint now);
  void advance(TimePoint now);
  TimePoint next_deadline() const { return deadline_; }

  enum class State { probing, passed, failed };
  State state() const { return state_; }
  // Why it has failed, for people.
  std::string why_failed() const;

  // Whether the controller had received the line in doubt; nothing while ?:CMD has shown neither.
  std::optional<bool> received() const { return received_; }
  // Reports whether no identity has been requested yet.
  bool in_first_step() const { return step_ == Step::echo; }
  // Returns the answer to the ?:CMD of the first step, even if a Stop has ended that step.
  const std::optional<std::string>& echo() const { return echo_; }
  // The expected one, or the same twice.
  const std::optional<Identity>& identity() const { return identity_; }

 private:
  // behind_stop: a ?:CMD whose answer shows only that all answers before it have come. Otherwise an identity requested
  // before the Stop and answered twice could pass for the one requested after it.
  enum class Step { echo, behind_stop, identity, silence };
  void begin(Step step, TimePoint now);
  int older_answers(Step step) const;
  void probe(TimePoint now);
  void expect_answer();
  void probe_again(TimePoint now);
  bool on_identity(Identity identity, TimePoint now);
  void silence_broken(TimePoint now);
  bool is_echo(std::string_view line) const;

  std::string line_in_doubt_;
  Limits limits_;
  OutstandingAnswers& outstanding_;
  std::function<bool(const Identity&)> is_known_;
  std::function<void(std::string_view)> write_;
  State state_ = State::probing;
  Step step_ = Step::echo;
  int probes_ = 0;
  // Probes of the same kind from before this step began, in an earlier barrier or before a Stop. The controller answers
  // in order, so their answers come first and prove nothing.
  int older_ = 0;
  bool question_before_stop_ = false;  // the ?:CMD of the first step may still be answered
  TimePoint deadline_{};
  TimePoint probed_{};
  Duration silence_{};
  TimePoint silence_limit_{};
  std::optional<bool> received_;
  std::optional<std::string> echo_;
  std::optional<Identity> identity_;
  std::optional<Identity> unconfirmed_;  // the newest answer that names another controller
};

// Whether `line` may be the answer to an outstanding probe; if so, that answer is no longer outstanding.
bool settle_outstanding(OutstandingAnswers& outstanding, std::string_view line);

}  // namespace axisgate::shrc203
