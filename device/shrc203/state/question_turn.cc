#include "device/shrc203/state/question_turn.h"

#include "device/core/guard.h"
#include "device/shrc203/limits.h"

namespace axisgate::shrc203 {

bool QuestionTurn::keeps_out(TimePoint now) {
  const auto question = waiting_();
  const bool has_turn = question && now - question->since >= kTurnAfter && now >= next_;
  if (!has_turn || !guarded(Guard::questions_have_turns)) {
    since_.reset();
    return false;
  }
  if (!since_) since_ = now;
  if (now - *since_ < kTurnLimit) return true;
  since_.reset();
  next_ = now + kTurnAfter;
  return false;
}

std::optional<TimePoint> QuestionTurn::limit() const {
  return since_ ? std::optional(*since_ + kTurnLimit) : std::nullopt;
}

}  // namespace axisgate::shrc203
