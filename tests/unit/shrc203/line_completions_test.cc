// Completions and answers: an axis number that arrives unrequested is distinguished from an answer, which may also be a
// bare number.
#include "tests/unit/shrc203/line_fixture.h"

namespace axisgate::shrc203::line_completions_test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string kIdentityLine = std::string(kIdentity) + "\r\n";

// No axis can complete unless a test starts one.
class LineOfSomeAxesTest : public LineFixture {
 protected:
  ExchangeRequest start(std::string_view text, AxisSet completes) const {
    ExchangeRequest one = request(text);
    one.completes = completes;
    return one;
  }
  // HRT: reports the axis number once it has found the origin (manual 60)).
  void home(int axis) {
    const std::string text = "HRT:" + std::to_string(axis);
    ask(start(text, AxisSet::of(axis)));
    script({{text + "\r\n", "OK\r\n"}});
  }
  AskedPtr ask_closed(std::string_view text) {
    ExchangeRequest one = request(text);
    one.closed = true;
    return ask(std::move(one));
  }
};

class LineCompletionsTest : public LineOfSomeAxesTest {
 protected:
  LineCompletionsTest() { open_and_rest(); }
};

TEST_F(LineCompletionsTest, ANumberThatIsExpectedIsACompletionAndOthersAreDoubtful) {
  home(2);
  receive("2\r\n1\r\n");
  EXPECT_THAT(news(), ElementsAre("completion 2", "completion 1 doubtful"));
  receive("0\r\n4\r\n");
  EXPECT_THAT(news(), ElementsAre("unexpected 0", "unexpected 4"));
}

TEST_F(LineCompletionsTest, TheQuestionThatHasWaitedLongestForThemIsKnown) {
  EXPECT_FALSE(line.held_question());
  home(1);
  ask("?:V");
  const TimePoint asked = now;
  ask("?:AXIS");
  script({{"?:V\r\n", "V2.00.000\r\n"}});
  ask("?:BEEP");
  const auto held = line.held_question();
  ASSERT_TRUE(held);
  EXPECT_EQ(held->line, "?:AXIS");
  EXPECT_EQ(held->caller, "somebody");
  EXPECT_EQ(held->since, asked);
  receive("1\r\n");
  pass(kReadyOutdatedMax);
  line.ready(kAllAxes, now);
  pass(kCompletionAfterReadyMax);
  EXPECT_TRUE(line.held_question()) << "until nothing can come any more";
  script({{"?:CMD\r\n", "?:V\r\n"}, {"?:AXIS\r\n", "6\r\n"}});
  EXPECT_FALSE(line.held_question());
  script({{"?:BEEP\r\n", "1\r\n"}});
}

// Even when no number can come any more, a motion that starts before the question is written would hold it back again.
TEST_F(LineCompletionsTest, AQuestionCountsAsHeldBackUntilItIsWritten) {
  ask("?:V");
  ask("?:AXIS");
  const auto held = line.held_question();
  ASSERT_TRUE(held);
  EXPECT_EQ(held->line, "?:AXIS");
  script({{"?:V\r\n", "V2.00.000\r\n"}});
  EXPECT_FALSE(line.held_question());
  script({{"?:AXIS\r\n", "6\r\n"}});
}

TEST_F(LineCompletionsTest, WhatTheLineHasLostIsHeldBackNoLonger) {
  home(1);
  ask("?:AXIS");
  ASSERT_TRUE(line.held_question());
  link_down("unplugged");
  EXPECT_FALSE(line.held_question());
  link_up();
  ask("?:AXIS");
  EXPECT_FALSE(line.held_question()) << "the handshake has not passed";
  forget();
}

TEST_F(LineCompletionsTest, AfterAConnectAnyMayCome) {
  link_down("unplugged");
  link_up();
  receive("3\r\n");
  script({{"*IDN?\r\n", kIdentityLine}});
  pass(kProbeLimit);
  open();
  receive("3\r\n");
  EXPECT_THAT(news(), ElementsAre("lost: unplugged", "completion 3 doubtful", "connected 2106001001", "completion 3"))
      << "the first of them in a barrier";
}

TEST_F(LineCompletionsTest, ANumberBetweenALineAndItsAnswerIsNotTheAnswer) {
  home(1);
  const auto version = ask("?:V"), setting = ask("O:1");
  script({{"?:V\r\n", "1\r\nV2.00.000\r\n"}, {"O:1\r\n", "1\r\nOK\r\n"}});
  EXPECT_EQ(version->reply(), "V2.00.000");
  EXPECT_TRUE(setting->result->accepted());
  EXPECT_THAT(news(), ElementsAre("completion 1", "completion 1"));
}

// Manual 86): the completion may arrive before the OK to its G:.
TEST_F(LineCompletionsTest, PossibleAsSoonAsTheStartIsWritten) {
  const auto go = ask(start("G:1", AxisSet::of(1)));
  EXPECT_TRUE(line.completions().possible(1));
  script({{"G:1\r\n", "1\r\nOK\r\n"}});
  EXPECT_TRUE(go->result->accepted());
  EXPECT_THAT(news(), ElementsAre("completion 1"));
}

TEST_F(LineCompletionsTest, ASettingThatChainsMayCompleteWithoutAGo) {
  ask("MP:2+P1000");
  script({{"MP:2+P1000\r\n", "OK\r\n"}});
  EXPECT_FALSE(line.completions().possible(2)) << "which waits for its G:";
  ask("MP:2+P1000");
  script({{"MP:2+P1000\r\n", "OK_D\r\n"}});
  EXPECT_EQ(line.completions().possible(), AxisSet::of(2));
}

TEST_F(LineCompletionsTest, SoMayOneWhoseAnswerWasLost) {
  ask("MP:2+P1000");
  script({{"MP:2+P1000\r\n", "O_D\r\n"}, {"?:CMD\r\n", ""}});
  EXPECT_EQ(line.completions().possible(), AxisSet::of(2));
}

// If no completion is possible, a number is an answer: the beep is on (manual 39)).
TEST_F(LineCompletionsTest, WithoutMotionANumberIsTheAnswer) {
  const auto beep = ask("?:BEEP");
  script({{"?:BEEP\r\n", "1\r\n"}});
  EXPECT_EQ(beep->reply(), "1");
  EXPECT_THAT(news(), IsEmpty());
}

TEST_F(LineCompletionsTest, ANumberThatCannotBeTheAnswerIsNot) {
  const auto beep = ask("?:BEEP");
  script({{"?:BEEP\r\n", "2\r\n1\r\n"}});
  EXPECT_EQ(beep->reply(), "1");
  EXPECT_THAT(news(), ElementsAre("completion 2 doubtful"));
}

// The answer is 0 or 1, so only the number of axis 1 could be mistaken for it.
TEST_F(LineCompletionsTest, AQuestionWaitsOnlyForNumbersThatItsAnswerCouldBe) {
  home(2);
  const auto beep = ask("?:BEEP"), wait = ask("?:W");
  script({{"?:BEEP\r\n", "2\r\n1\r\n"}});
  EXPECT_EQ(beep->reply(), "1");
  EXPECT_THAT(news(), ElementsAre("completion 2"));
  EXPECT_FALSE(wait->ended()) << "0 to 2550";
}

// READY, then 200 ms for a number still in transit, then one more exchange (manual 3.: answers come in order).
TEST_F(LineCompletionsTest, AQuestionWaitsUntilAllNumbersAreCertainlyIn) {
  home(1);
  pass(150);
  const auto beep = ask("?:BEEP");
  line.ready(AxisSet::of(1), now);
  EXPECT_THAT(listener.learnt, ElementsAre(LineLearned::What::ready));
  pass(199);
  EXPECT_EQ(sent(), "");
  pass(1);
  script({{"?:CMD\r\n", "HRT:1\r\n"}});
  EXPECT_EQ(line.completions().possible(), AxisSet()) << "that was the exchange";
  script({{"?:BEEP\r\n", "1\r\n"}});
  EXPECT_EQ(beep->reply(), "1");
}

TEST_F(LineCompletionsTest, TheLineAsksByItselfWhetherAllNumbersAreIn) {
  home(1);
  pass(150);
  line.ready(AxisSet::of(1), now);
  const auto beep = ask("?:BEEP");
  pass(150);
  ask("O:1");
  script({{"?:CMD\r\n", "HRT:1\r\n"}, {"O:1\r\n", "OK\r\n"}});
  EXPECT_EQ(line.completions().possible(), AxisSet::of(1)) << "answered too soon for that";
  pass(39);
  EXPECT_EQ(sent(), "");
  pass(1);
  script({{"!:\r\n", "1\r\nR\r\n"}, {"?:BEEP\r\n", "0\r\n"}});
  EXPECT_THAT(news(), ElementsAre("completion 1"));
  EXPECT_EQ(beep->reply(), "0");
}

TEST_F(LineCompletionsTest, AnAxisThatMovesAgainKeepsTheQuestionWaiting) {
  home(1);
  pass(150);
  line.ready(AxisSet::of(1), now);
  line.busy(AxisSet::of(1), now);
  line.busy(AxisSet::of(1), now);
  EXPECT_THAT(listener.learnt, ElementsAre(LineLearned::What::ready, LineLearned::What::busy)) << "each once";
  const auto beep = ask("?:BEEP");
  pass(seconds(10));
  EXPECT_FALSE(beep->ended());
  pass(1);
  EXPECT_FALSE(beep->written());
  EXPECT_EQ(beep->reason(), Reason::completion_outstanding);
}

// A person at the front panel may move the axis, or the line has turned a command of ours into another.
TEST_F(LineCompletionsTest, AnAxisThatIsSeenToMoveMayComplete) {
  line.busy(AxisSet::of(3), now);
  receive("3\r\n");
  EXPECT_THAT(news(), ElementsAre("completion 3"));
  EXPECT_THAT(listener.learnt, ElementsAre(LineLearned::What::busy));
}

TEST_F(LineCompletionsTest, ReadySoSoonAfterAStartIsOfTheTimeBeforeIt) {
  home(1);
  pass(144);
  line.ready(AxisSet::of(1), now);
  EXPECT_THAT(listener.learnt, IsEmpty()) << "149 ms after it was written";
  pass(1);
  line.ready(AxisSet::of(1), now);
  EXPECT_THAT(listener.learnt, ElementsAre(LineLearned::What::ready));
}

TEST_F(LineCompletionsTest, OthersGoMeanwhile) {
  home(1);
  const auto beep = ask("?:BEEP"), version = ask("?:V");
  script({{"?:V\r\n", "V2.00.000\r\n"}});
  EXPECT_EQ(version->reply(), "V2.00.000");
  EXPECT_FALSE(beep->ended());
}

// With one controllable axis ?:C has one field, with two it has a comma (manual 33)).
TEST_F(LineOfSomeAxesTest, AQuestionForAllAxesDoesNotWaitWhereThereAreTwo) {
  open_and_rest(AxisSet::of(1) | AxisSet::of(2));
  home(1);
  ask("?:C");
  script({{"?:C\r\n", "1\r\n1,1\r\n"}});
  EXPECT_THAT(news(), ElementsAre("completion 1"));
}

TEST_F(LineOfSomeAxesTest, AQuestionForTheOnlyAxisWaits) {
  open_and_rest(AxisSet::of(1));
  home(1);
  const auto excitation = ask("?:C");
  EXPECT_EQ(sent(), "");
  EXPECT_FALSE(excitation->ended());
}

// I: reports 0 to 63 (manual 95)): IN2 alone is a 2.
TEST_F(LineCompletionsTest, AClosedQuestionIsAnsweredByWhateverCameBeforeItsEnd) {
  home(2);
  const auto inputs = ask_closed("I:");
  script({{"I:\r\n", "2\r\n"}, {"!:S\r\n", "R,B,R\r\n"}});
  EXPECT_EQ(inputs->reply(), "2");
  EXPECT_THAT(inputs->result->candidates, ElementsAre(2)) << "the answer, or the axis";
  EXPECT_THAT(news(), IsEmpty());
  EXPECT_TRUE(listener.exchanges.back().closed);
  EXPECT_EQ(listener.writes.back().exchange, listener.exchanges.back().exchange) << "!:S belongs to it";
}

TEST_F(LineCompletionsTest, AmongSeveralNumbersTheOneThatIsNoAxisIsTheAnswer) {
  home(2);
  const auto inputs = ask_closed("I:");
  script({{"I:\r\n", "2\r\n"}, {"!:S\r\n", "12\r\nR,R,R\r\n"}});
  EXPECT_EQ(inputs->reply(), "12");
  EXPECT_THAT(inputs->result->candidates, IsEmpty());
  EXPECT_THAT(news(), ElementsAre("completion 2 doubtful"));
}

TEST_F(LineCompletionsTest, AnAxisThatCannotCompleteIsNotTakenForOne) {
  home(2);
  const auto inputs = ask_closed("I:");
  script({{"I:\r\n", "2\r\n"}, {"!:S\r\n", "1\r\nR,R,R\r\n"}});
  EXPECT_EQ(inputs->reply(), "1");
  EXPECT_THAT(news(), ElementsAre("completion 2 doubtful"));
}

TEST_F(LineCompletionsTest, AClosedQuestionIsNotClosedWithoutNeed) {
  home(2);
  const auto inputs = ask_closed("I:");
  script({{"I:\r\n", "12\r\n"}});
  EXPECT_EQ(inputs->reply(), "12");
  EXPECT_FALSE(listener.exchanges.back().closed);
  const auto alone = ask_closed("I:");
  script({{"I:\r\n", "1\r\n"}});
  EXPECT_EQ(alone->reply(), "1") << "axis 1 cannot complete";
}

TEST_F(LineCompletionsTest, WhatEndsAClosedQuestionIsDoubtedLikeAnyAnswer) {
  home(2);
  const auto inputs = ask_closed("I:");
  script({{"I:\r\n", "2\r\n"}, {"!:S\r\n", "OK\r\n"}, {"?:CMD\r\n", "!:S\r\n"}, {"*IDN?\r\n", kIdentityLine}});
  pass(kSilence);
  EXPECT_TRUE(inputs->result->in_doubt());
  EXPECT_THAT(inputs->message(), HasSubstr("\"I:\" was answered by \"OK\""));
  EXPECT_THAT(inputs->message(), HasSubstr("the controller had received it")) << "the line before was !:S";
}

// The answers to both parts of the question show that the controller runs.
TEST_F(LineCompletionsTest, ASlowClosedQuestionIsNoSignOfARestart) {
  home(2);
  pass(100);
  const auto inputs = ask_closed("I:");
  EXPECT_EQ(sent(), "I:\r\n");
  pass(100);
  receive("2\r\n");
  EXPECT_EQ(sent(), "!:S\r\n");
  pass(160);
  receive("R,R,R\r\n");
  EXPECT_EQ(inputs->reply(), "2");
  ask("?:V");
  script({{"?:V\r\n", "V2.00.000\r\n"}});
  EXPECT_THAT(news(), IsEmpty());
}

// The closing !:S has its own time limit.
TEST_F(LineCompletionsTest, WhatEndsAClosedQuestionMayBeLateToo) {
  home(2);
  const auto inputs = ask_closed("I:");
  script({{"I:\r\n", "2\r\n"}, {"!:S\r\n", ""}});
  pass(kProbeLimit - milliseconds(6));
  EXPECT_THAT(news(), IsEmpty());
  pass(1);
  EXPECT_THAT(news(), ElementsAre("barrier: \"I:\" was not answered in time"));
  EXPECT_EQ(sent(), "?:CMD\r\n");
  EXPECT_FALSE(inputs->ended());
}

TEST_F(LineCompletionsTest, ANumberInABarrierIsDoubtfulAndDoesNotBreakTheSilence) {
  home(1);
  const auto setting = ask("O:1");
  script({{"O:1\r\n", "K\r\n"}, {"?:CMD\r\n", "1\r\nO:1\r\n"}, {"*IDN?\r\n", kIdentityLine}});
  pass(100);
  receive("1\r\n");
  pass(92);
  EXPECT_TRUE(setting->ended());
  EXPECT_THAT(news(), ElementsAre(HasSubstr("barrier: "), "completion 1 doubtful", "completion 1 doubtful", "passed"));
}

// A program sends COMP and TRIG by itself (manual 109), 110)).
TEST_F(LineCompletionsTest, WhatAProgramTellsIsAnAnswerToNothing) {
  const auto question = ask("?:V");
  script({{"?:V\r\n", "COMP\r\nTRIG\r\nV2.00.000\r\n"}});
  EXPECT_EQ(question->reply(), "V2.00.000");
  EXPECT_THAT(news(), ElementsAre("program ended", "program trigger"));
}

TEST_F(LineCompletionsTest, WhatWasWrittenIsToldWithTheAxesThatMayComplete) {
  home(2);
  ASSERT_EQ(listener.writes.size(), 1u);
  EXPECT_EQ(listener.writes[0].bytes, "HRT:2\r\n");
  EXPECT_EQ(listener.writes[0].completes, AxisSet::of(2));
  EXPECT_EQ(listener.writes[0].lane, Lane::motion);
  EXPECT_EQ(listener.writes[0].who, "somebody");
}

}  // namespace
}  // namespace axisgate::shrc203::line_completions_test
