// Equal questions that wait share one exchange, unless their rights differ.
#include "tests/unit/shrc203/line_fixture.h"

namespace axisgate::shrc203::line_shared_questions_test {
namespace {

using std::chrono::milliseconds;

class LineSharedQuestionsTest : public LineFixture {
 protected:
  LineSharedQuestionsTest() { open_and_rest(); }
};

TEST_F(LineSharedQuestionsTest, IdenticalQuestionsShareAnExchange) {
  keep_the_line_busy();
  const auto first = ask("?:V"), second = ask("?:V"), spoken = ask("?:v");
  const auto poll = ask_in(Lane::poll, "?:V");
  EXPECT_EQ(line.queued(Lane::question), 1u);
  EXPECT_EQ(line.queued(Lane::poll), 1u);
  let_go();
  script({{"?:V\r\n", "V2.00.000\r\n"}});
  for (const auto& asked : {first, second, spoken}) EXPECT_EQ(asked->reply(), "V2.00.000");
  EXPECT_FALSE(poll->ended()) << "of another lane";
  script({{"?:V\r\n", "V2.00.001\r\n"}});
  EXPECT_EQ(poll->reply(), "V2.00.001");
}

TEST_F(LineSharedQuestionsTest, OnlyIdenticalQuestionsShareOne) {
  keep_the_line_busy();
  const auto version = ask("?:V"), model = ask("?:N");
  let_go();
  script({{"?:V\r\n", "V2.00.000\r\n"}, {"?:N\r\n", "SHRC-203\r\n"}});
  EXPECT_EQ(version->reply(), "V2.00.000");
  EXPECT_EQ(model->reply(), "SHRC-203");
}

TEST_F(LineSharedQuestionsTest, AMotionThatLosesItsRightTakesNoOtherQuestionWithIt) {
  keep_the_line_busy();
  ExchangeRequest question = request("?:V");
  question.motion = 1;
  const auto lost = ask(question);
  question.motion = 2;
  const auto kept = ask(question), shared = ask(question);
  EXPECT_EQ(line.queued(Lane::question), 2u);
  listener.refuses = [](const ExchangeRequest& asked) { return asked.motion == 1; };
  let_go();
  script({{"?:V\r\n", "V2.00.000\r\n"}});
  EXPECT_EQ(lost->reason(), Reason::lease_lost);
  EXPECT_EQ(kept->reply(), "V2.00.000");
  EXPECT_EQ(shared->reply(), "V2.00.000");
}

// The controller may have answered the question before the second caller asked.
TEST_F(LineSharedQuestionsTest, AQuestionOnTheWireIsNotShared) {
  const auto first = ask("?:V"), second = ask("?:V");
  script({{"?:V\r\n", "V2.00.000\r\n"}, {"?:V\r\n", "V2.00.001\r\n"}});
  EXPECT_EQ(first->reply(), "V2.00.000");
  EXPECT_EQ(second->reply(), "V2.00.001");
}

TEST_F(LineSharedQuestionsTest, WhatChangesSomethingIsNotShared) {
  keep_the_line_busy();
  ask("O:1");
  ask("O:1");
  ExchangeRequest closed = request("?:O");
  closed.closed = true;
  ask(closed);
  ask("?:O");
  EXPECT_EQ(line.queued(Lane::motion), 2u);
  EXPECT_EQ(line.queued(Lane::question), 2u);
}

TEST_F(LineSharedQuestionsTest, ASharedQuestionWaitsForWhoeverWaitsLongest) {
  keep_the_line_busy();
  ExchangeRequest question = request("?:V");
  question.not_after = now + milliseconds(20);
  const auto hasty = ask(question);
  question.not_after = now + milliseconds(200);
  ask(question);
  question.not_after = now + milliseconds(10);
  ask(question);
  pass(100);
  EXPECT_FALSE(hasty->ended());
  let_go();
  script({{"?:V\r\n", "V2.00.000\r\n"}});
  EXPECT_EQ(hasty->reply(), "V2.00.000");
}

}  // namespace
}  // namespace axisgate::shrc203::line_shared_questions_test
