// Requests for exchanges with the controller, and their results.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "device/core/lane.h"
#include "device/core/problem.h"
#include "device/core/task.h"
#include "device/core/time.h"
#include "device/shot/command/model.h"
#include "device/shot/command/reply.h"
#include "device/shot/stage.h"

namespace axisgate::shot {

struct ExchangeRequest {
  Command command;
  Lane lane = Lane::question;
  std::string caller;
  std::string identity{};   // takes the turn, with a share of the lane; empty: `caller`, without one
  TimePoint not_after{};    // latest time for writing the line
  MotionId motion = 0;      // motion that the line belongs to; 0 for none
  std::uint64_t lease = 0;  // lease of the request; for lines without a motion
  AxisSet uses;             // axes that a line without a motion needs the right to
  bool tidies = false;      // the line only restores what the motion changed, so it needs no right
  AxisSet completes;        // axes that may complete once the line is written
  bool handshake = false;   // the line may be sent before open()
  bool closed = false;      // an !:S follows a number that could be a completion, and shows that all have arrived
};

struct ExchangeResult {
  bool written = false;              // false: the controller has certainly not received the line
  std::optional<Reply> reply{};      // set if a reply was matched
  std::optional<Problem> problem{};  // reason why no reply can be trusted; also set for NG_I
  // Evidence from ?:CMD for an exchange in doubt: whether the controller received the line. nullopt if there is none.
  std::optional<bool> received{};

  // All numbers of a closed exchange whose reply could not be distinguished from completions. `reply` is the first.
  std::vector<int> candidates{};

  bool accepted() const { return reply && reply->accepted() && !problem; }
  bool refused() const { return reply && reply->kind == Reply::Kind::ng; }
  // Reports whether the line was written and its effect is unknown.
  bool in_doubt() const { return written && problem.has_value(); }
};

// A HeldQuestion is a question that waits until no completion could be taken for its reply.
struct HeldQuestion {
  std::string line, caller;
  TimePoint since{};
};

// A Waiting line is queued or in flight, with those who wait for its result.
struct Waiting {
  ExchangeRequest request;
  std::vector<OneShot<ExchangeResult>> answers;
  TimePoint asked;

  void deliver(const ExchangeResult& result) {
    for (auto& answer : answers) answer.deliver(result);
  }
};
using WaitingPtr = std::shared_ptr<Waiting>;

}  // namespace axisgate::shot
