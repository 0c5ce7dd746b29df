// A question whose answer could be taken for a completion waits until none is possible. Where motions follow one
// another without a pause, that is never. So after kTurnAfter it has its turn: no motion enters the gate before it was
// sent. What is inside is not interrupted: it ends, and a path continues, with its refills.
//
//   asked ── kTurnAfter ── a motion could enter: kept out ── the last completion, READY, settled ── sent: all may enter
//                            └ for kTurnLimit at most. Then all may enter, and the next turn is kTurnAfter later
#pragma once

#include <functional>
#include <optional>

#include "device/core/time.h"
#include "device/shrc203/line/line.h"

namespace axisgate::shrc203 {

class QuestionTurn {
 public:
  // The question that has waited longest, as Line::held_question().
  using Waiting = std::function<std::optional<HeldQuestion>()>;

  explicit QuestionTurn(Waiting waiting) : waiting_(std::move(waiting)) {}

  // Whether it keeps out a motion that could enter now. Its limit counts from the first such motion.
  bool keeps_out(TimePoint now);
  // No motion could enter now.
  void keeps_nobody_out() { since_.reset(); }

  // The question that keeps a motion out, and until when at most; nothing where none does.
  std::optional<HeldQuestion> question() const { return since_ ? waiting_() : std::nullopt; }
  std::optional<TimePoint> limit() const;

 private:
  Waiting waiting_;
  std::optional<TimePoint> since_;  // it has kept a motion out since then
  TimePoint next_{};                // not before
};

}  // namespace axisgate::shrc203
