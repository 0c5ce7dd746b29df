// Recovery after a missing or unreadable reply. No other line is sent until it is certain again which command a reply
// answers.
//
//   ?:CMD    a reply equal to the line in doubt shows that the controller received the line, not that it accepted it
//   *IDN?    the reply shows that the configured controller is there and has sent every earlier reply. One damaged byte
//            turns it into another controller's, so an unknown identity counts only if it is received twice
//   silence  no lines except completions for the longest of 50 ms, the time of three longest lines, and twice the time
//            of the identity's reply: a slow controller may still send other replies
//
// A probe without a reply is repeated, three in all. The reply to each unanswered probe is outstanding: it may still
// arrive later, and is discarded whenever it does.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "device/core/time.h"
#include "device/shot/command/model.h"
#include "device/shot/command/reply.h"

namespace axisgate::shot {

// Number of replies to abandoned probes that may still arrive.
struct OutstandingAnswers {
  int echoes = 0;
  int identities = 0;
};

class Barrier {
 public:
  struct Limits {
    Duration reply;  // time for the reply to a probe
    Duration silence;
  };

  // `line_in_doubt` is empty after a connect without ?:CMD, and kAnyLine after a connect that begins with ?:CMD. With
  // kAnyLine the barrier sends *IDN? even if ?:CMD is not answered. `is_known` reports whether an identity is that of
  // the expected controller. `write` sends one line.
  static constexpr std::string_view kAnyLine = "?";
  Barrier(const Model& model, std::string line_in_doubt, Limits limits, OutstandingAnswers& outstanding,
          std::function<bool(const Identity&)> is_known,
          std::function<void(std::string_view line, TimePoint now)> write);

  void start(TimePoint now);
  // Begins again because a stop was written meanwhile.
  void restart(TimePoint now);

  // Takes a complete line that is not a completion. Returns false if nothing waited for the line.
  bool on_line(std::string_view line, TimePoint now);
  // Takes note that part of a line was received.
  void on_half_line(TimePoint now);
  void advance(TimePoint now);
  TimePoint next_deadline() const { return deadline_; }

  enum class State { probing, passed, failed };
  State state() const { return state_; }
  // Returns the reason of the failure as text for people.
  std::string why_failed() const;

  // Reports whether the controller received the line in doubt; nullopt until ?:CMD has shown it.
  std::optional<bool> received() const { return received_; }
  // Reports whether *IDN? has not been sent yet.
  bool in_first_step() const { return step_ == Step::echo; }
  // Returns the reply to the ?:CMD of the first step, even if a stop has ended that step.
  const std::optional<std::string>& echo() const { return echo_; }
  // Returns the accepted identity: the expected controller's, or another one that was received twice.
  const std::optional<Identity>& identity() const { return identity_; }

 private:
  // after_stop: a ?:CMD whose reply shows only that all earlier replies have arrived. Without it, two replies to an
  // *IDN? sent before the stop could pass for the reply to the *IDN? sent after it.
  enum class Step { echo, after_stop, identity, silence };
  void begin(Step step, TimePoint now);
  int older_answers(Step step) const;
  void probe(TimePoint now);
  void expect_answer();
  void probe_again(TimePoint now);
  bool on_identity(Identity identity, TimePoint now);
  void silence_broken(TimePoint now);
  // Reports whether the line can be a reply to ?:CMD: a command. No other reply of a model looks like a command.
  bool is_known_command(std::string_view line) const { return model_.parse(line).has_value(); }
  bool is_echo(std::string_view line) const;
  bool settle_outstanding(std::string_view line);

  const Model& model_;
  std::string line_in_doubt_;
  Limits limits_;
  OutstandingAnswers& outstanding_;
  std::function<bool(const Identity&)> is_known_;
  std::function<void(std::string_view line, TimePoint now)> write_;
  State state_ = State::probing;
  Step step_ = Step::echo;
  int probes_ = 0;
  // Number of unanswered probes of the same kind from before this step, in an earlier barrier or before a stop. The
  // controller replies in order, so their replies come first and prove nothing.
  int older_ = 0;
  bool question_before_stop_ = false;  // the reply to the first step's ?:CMD may still arrive
  TimePoint deadline_{};
  TimePoint probed_{};
  Duration silence_{};
  TimePoint silence_limit_{};
  std::optional<bool> received_;
  std::optional<std::string> echo_;
  std::optional<Identity> identity_;
  std::optional<Identity> unconfirmed_;  // the newest identity of another controller
};

// Reports whether `line` may be the reply to an outstanding probe. If so, removes that reply from `outstanding`.
bool settle_outstanding(const Model& model, OutstandingAnswers& outstanding, std::string_view line);

}  // namespace axisgate::shot
