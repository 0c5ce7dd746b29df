// Tests of answers that look like a notice with an axis number. In every order of an answer and the notices, the caller
// must receive the device's answer, and each number must be counted once. The tests cover every row of the command
// table whose answer can be a bare number, every set of axes with outstanding numbers, and every value worth testing.
// Nothing is random: each order is tried.
#include <gtest/gtest.h>

#include "device/shrc203/command/command_table.h"
#include "tests/interleavings/fixture.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using Moment = Question::Moment;

// No such row may rely on the grammar, which would accept a notice as an answer.
TEST_F(Interleavings, EachSuchRowIsKeptApart) {
  for (const CommandRow& row : model().commands()) {
    if (!bare_number_range(row)) continue;
    EXPECT_NE(row.separation, Separation::grammar) << row.name;
    EXPECT_EQ(row.effect, Effect::question) << row.name;
  }
}

// Uses all sets of controllable axes, because for rows that answer only 0 and 1 it matters which axes these are.
TEST_F(Interleavings, WhileTheAxesMove) {
  each_question(every_row, subsets(kAllAxes), [this](Question question) { try_all(question); });
}

// More motions and their axis numbers may follow in the same transaction, so no row can be closed by !:S.
TEST_F(Interleavings, WhileACallersOwnMotionRuns) {
  each_question(closed_rows, subsets(kAllAxes), [this](Question question) {
    question.by_execute = true;
    try_all(question);
  });
}

// A question that waits is refused without being sent, and no axis number is lost. Other questions are answered as
// above.
TEST_F(Interleavings, WhileTheAxesMoveForLongerThanTheQuestionMayWait) {
  each_question(rows_of_host, subsets(kAllAxes), [this](Question question) {
    question.moment = Moment::moving_beyond_its_time;
    const bool first =
        question.value == values_of(*question.row).front();  // the question is not answered, so one value is enough
    if (question.waits() && first) try_all(question);
  });
}

TEST_F(Interleavings, AfterReady) {
  each_question(every_row, counts(), [this](Question question) {
    question.moment = Moment::standing;
    try_all(question);
  });
}

}  // namespace
}  // namespace axisgate::simulation
