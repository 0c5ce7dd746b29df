// Single exchanges for the gateway's own lines and those of motions.
#pragma once

#include <string>

#include "device/core/tasks.h"
#include "device/shot/line/line.h"
#include "device/shrc203/command/builders.h"
#include "device/shrc203/state/live_motion.h"

namespace axisgate::shrc203 {

class Dialogue {
 public:
  using Question = commands::Question;

  Dialogue(Line& line, const Tasks& tasks) : line_(line), tasks_(tasks) {}

  // Sends one line. co_await always yields an ExchangeResult.
  OneShot<ExchangeResult> exchange(ExchangeRequest request) { return line_.exchange(std::move(request), tasks_.now()); }

  Task<ExchangeResult> ask(Command command, Lane lane, std::string caller, bool in_handshake = false);
  Task<ExchangeResult> ask(Question question, Lane lane, std::string caller, bool in_handshake = false) {
    return ask(commands::ask(question), lane, std::move(caller), in_handshake);
  }

  // Returns the request for a line of the motion. The line is written by the motion's not_after while the motion is
  // queued, otherwise within kStepWriteLimit.
  ExchangeRequest request_of(const LiveMotion& live, Command command, Lane lane) const;
  // Asks until two replies in a row agree, since one lost byte makes another reply. Fails with line_fault.
  Task<Result<Reply>> ask_twice(LiveMotionPtr live, Command question);

 private:
  Line& line_;
  const Tasks& tasks_;
};

}  // namespace axisgate::shrc203
