#include "device/shrc203/session/dialogue.h"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>

#include "device/shrc203/limits.h"

namespace axisgate::shrc203 {

Task<ExchangeResult> Dialogue::ask(Command command, Lane lane, std::string caller, bool in_handshake) {
  ExchangeRequest request;
  request.command = std::move(command);
  request.lane = lane;
  request.caller = std::move(caller);
  request.not_after = tasks_.now() + kStepWriteLimit;
  request.handshake = in_handshake;
  auto pending = exchange(std::move(request));
  auto result = co_await pending;
  co_return result;
}

ExchangeRequest Dialogue::request_of(const LiveMotion& live, Command command, Lane lane) const {
  ExchangeRequest request;
  request.command = std::move(command);
  request.lane = lane;
  request.caller = live.context.who;
  const bool queued = live.motion.state == MotionState::queued;
  request.not_after = queued ? live.context.not_after : tasks_.now() + kStepWriteLimit;
  request.motion = live.motion.id;
  return request;
}

Task<Result<Reply>> Dialogue::ask_twice(LiveMotionPtr live, Command question) {
  std::optional<std::string> before;
  for (int attempt = 0; attempt < kAgreeingAnswerTries; ++attempt) {
    auto request = request_of(*live, question, Lane::motion);
    request.not_after = tasks_.now() + kStepWriteLimit;
    auto pending = exchange(std::move(request));
    const auto result = co_await pending;
    if (result.problem) co_return tl::unexpected(*result.problem);
    if (before == result.reply->text) co_return *result.reply;
    before = result.reply->text;
  }
  co_return fail(Reason::line_fault, fmt::format("{} is answered otherwise every time", question.line),
                 "check the cable");
}

}  // namespace axisgate::shrc203
