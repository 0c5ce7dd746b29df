// Tests of orders of an answer and axis numbers in which a number was once not counted exactly once.
#include <gtest/gtest.h>

#include "device/shot/line/completions.h"
#include "device/shrc203/command/command_table.h"
#include "device/shrc203/limits.h"
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
    question.row = &model().row(row);
    question.controllable = question.moving = axes;
    question.value = value;
    return question;
  }
};

// Both callers share the exchange in which the number arrives with the answer, and both deduce the number.
TEST_F(InterleavingsOnceWrong, ANumberIsCountedForEachCallerOfASharedExchange) {
  Question question = question_of("?:O", AxisSet::of(1), 1);
  question.shared = true;
  try_all(question);
}

// The question is repeated because a number arrived with its answer. At the second answer no number is possible any
// longer, so the answer is certain, and the number with the first answer was forgotten.
TEST_F(InterleavingsOnceWrong, ANumberIsForgottenWhenTheLastAnswerIsCertain) {
  Question question = question_of("?:O", AxisSet::of(1) | AxisSet::of(2), 1);
  question.moment = Moment::standing;
  question.after_ready = kCompletionAfterReadyMax - milliseconds(2);
  try_all(question);
}

// Tries every order with two callers and at most two moving axes: with three axes there are 100,000 orders, which take
// too long.
TEST_F(InterleavingsOnceWrong, TwoCallersAtOnce) {
  each_question(closed_rows, subsets(kAllAxes), [this](Question question) {
    question.shared = true;
    if (question.moving.count() < kAxisCount) try_all(question);
  });
}

TEST_F(InterleavingsOnceWrong, JustBeforeNoNumberCanComeAnyMore) {
  // 5 ms before: two equal answers still arrive in time. 2 ms before: not even the first one does.
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
