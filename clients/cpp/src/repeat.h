// When a request is sent again, without a clock and without a connection.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "clients/cpp/src/failure.h"

namespace axisgate::client {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

// A Backoff is a series of pauses, each twice as long as the previous one.
class Backoff {
 public:
  milliseconds pause();
  void reset() { next_ = kFirst; }

 private:
  static constexpr milliseconds kFirst{250}, kLongest{5000};
  milliseconds next_ = kFirst;
};

struct RepeatTerms {
  Clock::time_point until;  // latest time of an attempt
  std::string target;       // address of the daemon, for messages
  milliseconds answer;      // time for the answer to an attempt
  bool acts = false;        // false: a question, which may always be repeated
  // False if the daemon does not remember requests: a request that acts is then not repeated once it may have reached
  // the daemon.
  bool remembered = false;
};

// A Repeat decides after each failed attempt whether the same request is sent again.
class Repeat {
 public:
  explicit Repeat(RepeatTerms terms) : terms_(std::move(terms)) {}

  // Returns the time limit of an attempt that is sent at `now`.
  milliseconds limit(Clock::time_point now) const;
  // Returns the pause after which the same request is sent again. Throws the error with which the call ends.
  milliseconds pause_after(const Failure& failure, Clock::time_point now);

 private:
  bool may_be_repeated(const Failure& failure) const;
  [[noreturn]] void end(const Failure& failure) const;

  const RepeatTerms terms_;
  Backoff backoff_;
  bool may_have_acted_ = false;
};

}  // namespace axisgate::client
