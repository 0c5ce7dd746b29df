// Orders of an answer and axis numbers in which a number was not counted once.
#include <gtest/gtest.h>

#include "device/shrc203/limits.h"
#include "device/shrc203/line/completions.h"
#include "tests/interleavings/fixture.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::milliseconds;
using Moment = Question::Moment;

class InterleavingsOnceWrong : public Interleavings {
 protected:
  static Question question_of(std::string_view row, AxisSet axes, int value) {
    Question question;
    question.row = &command_row(row);
    question.controllable = question.moving = axes;
    question.value = value;
    return question;
  }
};

// Both callers share the exchange in which the number comes beside the answer, and each of them deduces it.
TEST_F(InterleavingsOnceWrong, ANumberIsCountedForEachCallerOfASharedExchange) {
  Question question = question_of("?:O", AxisSet::of(1), 1);
  question.shared = true;
  try_all(question);
}

// The question is asked again because a number came beside its answer, and by then no number is possible any more: the
// answer is certain, and what came with the one before is forgotten.
TEST_F(InterleavingsOnceWrong, ANumberIsForgottenWhenTheLastAnswerIsCertain) {
  Question question = question_of("?:O", AxisSet::of(1) | AxisSet::of(2), 1);
  question.moment = Moment::standing;
  question.after_ready = kCompletionAfterReadyMax - milliseconds(2);
  try_all(question);
}

// The same in every order, of two axes at most: with three there are 100,000, which take their time.
TEST_F(InterleavingsOnceWrong, TwoCallersAtOnce) {
  each_question(closed_rows, subsets(AxisSet::all()), [this](Question question) {
    question.shared = true;
    if (question.moving.count() < kAxisCount) try_all(question);
  });
}

TEST_F(InterleavingsOnceWrong, JustBeforeNoNumberCanComeAnyMore) {
  // From where two answers that agree still come in time, to where the first of them does not.
  for (const int before : {5, 2}) {
    each_question(closed_rows, counts(), [&](Question question) {
      question.moment = Moment::standing;
      question.after_ready = kCompletionAfterReadyMax - milliseconds(before);
      try_all(question);
    });
  }
}

}  // namespace
}  // namespace axisgate::simulation
