// The questions about the outcome of a motion, without a clock and without a connection.
#pragma once

#include "axisgate/v1/motion.pb.h"
#include "axisgate/v1/stage.pb.h"
#include "clients/cpp/src/repeat.h"

namespace axisgate::client {

// Reports whether the motion has its outcome.
inline bool is_over(const v1::Motion& motion) { return motion.has_end_time(); }

// A Following asks for the outcome of one motion, also over broken connections and restarts of the daemon.
class Following {
 public:
  Following(v1::Motion motion, std::string target, Clock::time_point now)
      : motion_(std::move(motion)), target_(std::move(target)), answered_(now) {}

  const v1::Motion& motion() const { return motion_; }
  bool over() const { return is_over(motion_); }

  // Returns the next question, which waits at most `wait`.
  v1::WaitMotionRequest question(milliseconds wait) const;
  // Returns the time limit of a question.
  static milliseconds limit(const v1::WaitMotionRequest& question);
  // Takes an answer. Throws OutcomeUnknown if it is about another motion: a daemon without a journal uses the names of
  // motions again after a restart.
  void take(v1::Motion motion, Clock::time_point now);
  // Returns the pause after which the daemon is asked again. Throws OutcomeUnknown if it is not.
  milliseconds pause_after(const Failure& failure, Clock::time_point now);

 private:
  [[noreturn]] void end(std::string_view why) const;

  v1::Motion motion_;
  const std::string target_;
  Clock::time_point answered_;
  Backoff backoff_;
};

}  // namespace axisgate::client
