// A number that comes by itself, a notice, looks like some answers. Whatever the order in which an answer and the
// notices come, the caller gets the device's answer, and each number is counted once: for every row of the command
// table whose answer can be a bare number, for every set of axes whose numbers are yet to come, and for every value
// that means something. Nothing is drawn: each order is tried.
#include <gtest/gtest.h>

#include "tests/interleavings/fixture.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using Moment = Question::Moment;

// None of them is left to the grammar, which takes a notice for an answer.
TEST_F(Interleavings, EachSuchRowIsKeptApart) {
  for (const CommandRow& row : command_table()) {
    if (!bare_number_range(row)) continue;
    EXPECT_NE(row.separation, Separation::grammar) << row.name;
    EXPECT_EQ(row.effect, Effect::question) << row.name;
  }
}

// With all sets of controllable axes: which the one or the two are matters where a row answers 0 and 1 only.
TEST_F(Interleavings, WhileTheAxesMove) {
  each_question(every_row, subsets(AxisSet::all()), [this](Question question) { try_all(question); });
}

// More motions may follow in the same lines, and their numbers: no row is closed by an !:S then.
TEST_F(Interleavings, WhileACallersOwnMotionRuns) {
  each_question(closed_rows, subsets(AxisSet::all()), [this](Question question) {
    question.by_execute = true;
    try_all(question);
  });
}

// What waits is refused, never sent, and costs no number. What does not wait is answered as above.
TEST_F(Interleavings, WhileTheAxesMoveForLongerThanTheQuestionMayWait) {
  each_question(rows_of_host, subsets(AxisSet::all()), [this](Question question) {
    question.moment = Moment::moving_beyond_its_time;
    const bool first = question.value == values_of(*question.row).front();  // it is not answered: one is enough
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
