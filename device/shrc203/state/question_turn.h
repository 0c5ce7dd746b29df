// Turn of a question whose reply could be taken for a completion. Such a question waits until no completion is
// possible, which may never happen while motions follow one another without a pause. So after kTurnAfter it has its
// turn: no motion enters the gate until the question was sent. Motions inside are not interrupted: they end, and a path
// continues, with its refills.
//
//   asked ── kTurnAfter ── a motion could enter: kept out ── the last completion, READY, settled ── sent: all may enter
//                            └ for kTurnLimit at most. Then all may enter, and the next turn is kTurnAfter later
#pragma once

#include <functional>
#include <optional>

#include "device/core/time.h"
#include "device/shot/line/line.h"
#include "device/shrc203/stage.h"

namespace axisgate::shrc203 {

class QuestionTurn {
 public:
  // Returns the longest waiting question, like Line::held_question().
  using Waiting = std::function<std::optional<HeldQuestion>()>;

  explicit QuestionTurn(Waiting waiting) : waiting_(std::move(waiting)) {}

  // Reports whether a question keeps out a motion that could enter now. The time limit of its turn counts from the
  // first such motion.
  bool keeps_out(TimePoint now);
  // Called when no motion could enter now.
  void keeps_nobody_out() { since_.reset(); }

  // Return the question that keeps a motion out, and the end of its turn; nullopt if there is none.
  std::optional<HeldQuestion> question() const { return since_ ? waiting_() : std::nullopt; }
  std::optional<TimePoint> limit() const;

 private:
  Waiting waiting_;
  std::optional<TimePoint> since_;  // time since when a motion has been kept out
  TimePoint next_{};                // earliest time of the next turn
};

}  // namespace axisgate::shrc203
