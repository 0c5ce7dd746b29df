// One exchange and its answer, as the gateway's own lines and those of motions have it.
#pragma once

#include <string>

#include "device/core/tasks.h"
#include "device/shrc203/command/builders.h"
#include "device/shrc203/line/line.h"
#include "device/shrc203/state/live_motion.h"

namespace axisgate::shrc203 {

class Dialogue {
 public:
  using Question = commands::Question;

  Dialogue(Line& line, const Tasks& tasks) : line_(line), tasks_(tasks) {}

  // To await: it yields an ExchangeResult, always.
  OneShot<ExchangeResult> exchange(ExchangeRequest request) { return line_.exchange(std::move(request), tasks_.now()); }

  Task<ExchangeResult> ask(Command command, Lane lane, std::string caller, bool in_handshake = false);
  Task<ExchangeResult> ask(Question question, Lane lane, std::string caller, bool in_handshake = false) {
    return ask(commands::ask(question), lane, std::move(caller), in_handshake);
  }

  // A line of the motion: to be written by its not_after while it has not started, then within kStepWriteLimit.
  ExchangeRequest request_of(const LiveMotion& live, Command command, Lane lane) const;
  // The same answer in a row: one byte that the line lost would make another of it. line_fault.
  Task<Result<Reply>> ask_twice(LiveMotionPtr live, Command question);

 private:
  Line& line_;
  const Tasks& tasks_;
};

}  // namespace axisgate::shrc203
