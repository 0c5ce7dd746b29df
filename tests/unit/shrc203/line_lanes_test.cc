// Order in which waiting lines are sent, and the fate of those that wait.
#include "tests/unit/shrc203/line_fixture.h"

namespace axisgate::shrc203::line_lanes_test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::IsEmpty;

class LineLanesTest : public LineFixture {
 protected:
  LineLanesTest() { open_and_rest(); }
};

TEST_F(LineLanesTest, AStopGoesFirstAndThenTheLanesInTheirOrder) {
  keep_the_line_busy();
  ask_in(Lane::poll, "Q:SPC");
  ask("?:V");
  ask("O:1");
  ask_in(Lane::path_refill, "MP:1+P1000");
  ask("L:1");
  let_go();
  script({{"L:1\r\n", "OK\r\n"},
          {"MP:1+P1000\r\n", "OK_D\r\n"},
          {"O:1\r\n", "OK\r\n"},
          {"?:V\r\n", "V2.00.000\r\n"},
          {"Q:SPC\r\n", "P+0,P+0,P+0,0,0,0,R,R,R\r\n"}});
}

TEST_F(LineLanesTest, ManyStopsDoNotKeepOthersFromTheLine) {
  keep_the_line_busy();
  ask("L:1");
  ask("L:2");
  ask("L:3");
  ask("?:V");
  let_go();
  script({{"L:1\r\n", "OK\r\n"}, {"?:V\r\n", "V2.00.000\r\n"}, {"L:2\r\n", "OK\r\n"}, {"L:3\r\n", "OK\r\n"}});
}

// The question is written, but its answer is not awaited.
TEST_F(LineLanesTest, AfterAPauseAStopIsRightBehindTheQuestion) {
  ask("O:1");
  script({{"O:1\r\n", "OK\r\n"}});
  pass(seconds(1));
  ask("?:V");
  const auto stop = ask("L:1");
  script({{"?:CMD\r\n", "O:1\r\n"}, {"L:1\r\n", "OK\r\n"}, {"?:V\r\n", "V2.00.000\r\n"}});
  pass(seconds(1));
  const auto alone = ask("L:1");
  EXPECT_EQ(sent(), "?:CMD\r\nL:1\r\n");
  pass(5);
  receive("?:V\r\n");
  EXPECT_FALSE(alone->ended());
  receive("OK\r\n");
  EXPECT_TRUE(stop->result->accepted());
  EXPECT_TRUE(alone->result->accepted());
}

// A stop that the line has cut in two is refused twice.
TEST_F(LineLanesTest, BehindARefusedStopTheNextOneWaitsTwentyMilliseconds) {
  const auto stop = ask("L:1");
  script({{"L:1\r\n", "NG\r\n"}});
  EXPECT_TRUE(stop->result->refused());
  const auto second = ask("L:2");
  pass(10);
  receive("NG\r\n");
  EXPECT_THAT(news(), ElementsAre("unexpected NG"));
  pass(9);
  EXPECT_EQ(sent(), "");
  pass(1);
  script({{"L:2\r\n", "NG\r\n"}});
  EXPECT_TRUE(second->result->refused()) << "any other NG would have come by now";
}

TEST_F(LineLanesTest, AStopBehindAnotherRefusedLineIsDoubtedWhenItMeetsNG) {
  ask("O:1");
  script({{"O:1\r\n", "NG\r\n"}});
  const auto stop = ask("L:1");
  script({{"L:1\r\n", "NG\r\n"}, {"?:CMD\r\n", "L:1\r\n"}, {"*IDN?\r\n", std::string(kIdentity) + "\r\n"}});
  pass(kSilence);
  EXPECT_FALSE(stop->result->refused()) << "it may be the other half's NG";
  EXPECT_TRUE(stop->result->in_doubt());
}

TEST_F(LineLanesTest, ARefusedStopLongAgoMakesNoDifferenceToThat) {
  ask("L:1");
  script({{"L:1\r\n", "NG\r\n"}});
  pass(20);
  ask("O:1");
  script({{"?:CMD\r\n", "L:1\r\n"}, {"O:1\r\n", "NG\r\n"}});
  const auto stop = ask("L:2");
  script({{"L:2\r\n", "NG\r\n"}, {"?:CMD\r\n", ""}});
  EXPECT_FALSE(stop->ended());
}

TEST_F(LineLanesTest, AStopBehindNGGoesBeforeTheQuestionThatOthersWaitFor) {
  const auto refused = ask("C:11"), waiting = ask("O:1"), stop = ask("L:1");
  script({{"C:11\r\n", "NG\r\n"}, {"L:1\r\n", "OK\r\n"}, {"?:CMD\r\n", "L:1\r\n"}, {"O:1\r\n", "OK\r\n"}});
  EXPECT_TRUE(refused->result->refused());
  EXPECT_TRUE(stop->result->accepted());
  EXPECT_TRUE(waiting->result->accepted());
}

TEST_F(LineLanesTest, AStopDoesNotWaitForTheOtherHalfOfALine) {
  receive("O");
  const auto stop = ask("L:1");
  EXPECT_EQ(sent(), "L:1\r\n");
  receive("OK\r\n");
  EXPECT_TRUE(stop->result->accepted()) << "OOK would have been no answer";
}

TEST_F(LineLanesTest, NothingIsWrittenLaterThanItMay) {
  keep_the_line_busy();
  ExchangeRequest setting = request("O:1");
  setting.not_after = now + milliseconds(100);
  const auto late = ask(setting);
  pass(100);
  EXPECT_FALSE(late->ended());
  pass(1);
  EXPECT_FALSE(late->written());
  EXPECT_EQ(late->reason(), Reason::deadline_passed);
  EXPECT_EQ(late->result->problem->sent, "O:1");
  EXPECT_FALSE(late->result->in_doubt());
  EXPECT_THAT(listener.limits, ElementsAre("queue"));
  let_go();
  EXPECT_EQ(sent(), "");
}

TEST_F(LineLanesTest, OnlyTheChosenAreWithdrawnAndWhatIsOnTheWireNever) {
  const auto written = ask("O:1"), first = ask("O:2"), second = ask("O:3");
  line.withdraw([](const ExchangeRequest& one) { return one.command.line != "O:3"; },
                Problem{Reason::stopped, "somebody stopped it", {}, {}, {}, {}});
  executor.run();
  EXPECT_FALSE(written->ended());
  EXPECT_FALSE(first->written());
  EXPECT_EQ(first->reason(), Reason::stopped);
  EXPECT_EQ(first->result->problem->sent, "O:2");
  script({{"O:1\r\n", "OK\r\n"}, {"O:3\r\n", "OK\r\n"}});
  EXPECT_TRUE(second->result->accepted());
}

TEST_F(LineLanesTest, ASealedLineCarriesNothingButStops) {
  const auto written = ask("O:1"), waiting = ask("O:2");
  ExchangeRequest handshake = request("Q:SPC");
  handshake.handshake = true;
  const auto resting = ask(handshake);
  line.seal(Problem{Reason::not_sent, "the gateway ends", {}, {}, {}, {}});
  executor.run();
  EXPECT_EQ(waiting->reason(), Reason::not_sent);
  EXPECT_FALSE(waiting->written());
  const auto next = ask("?:V");
  EXPECT_EQ(next->reason(), Reason::not_sent);
  EXPECT_FALSE(next->written());
  const auto stop = ask("L:1"), later = ask(handshake);
  script({{"O:1\r\n", "OK\r\n"}, {"L:1\r\n", "OK\r\n"}});
  EXPECT_TRUE(written->result->accepted());
  EXPECT_TRUE(stop->result->accepted());
  EXPECT_FALSE(resting->ended() || later->ended()) << "refused, it would be taken for failed";
}

TEST_F(LineLanesTest, AFullLaneTakesNoMore) {
  keep_the_line_busy();
  for (std::size_t i = 0; i < LaneQueue<int>::kLaneMax; ++i) ask("O:1");
  const auto one_more = ask("O:1");
  EXPECT_FALSE(one_more->written());
  EXPECT_EQ(one_more->reason(), Reason::queue_full);
  EXPECT_FALSE(ask("?:V")->ended()) << "another lane";
}

// A motion's lines are bounded by its turn and must not fail because the same caller has many other lines.
TEST_F(LineLanesTest, ACallersOwnLinesHaveAShareOfALane) {
  keep_the_line_busy();
  ExchangeRequest own = request("O:1");
  own.identity = "somebody over TCP";
  for (std::size_t i = 0; i < LaneQueue<int>::kShareMax; ++i) ask(own);
  const auto one_more = ask(own);
  EXPECT_FALSE(one_more->written());
  EXPECT_EQ(one_more->reason(), Reason::queue_full);
  EXPECT_EQ(one_more->result->problem->sent, "O:1");
  ExchangeRequest of_a_motion = request("M:1+P1000");
  of_a_motion.motion = 7;
  EXPECT_FALSE(ask(of_a_motion)->ended());
}

// The connections differ, and so do the callers' names.
TEST_F(LineLanesTest, ThoseOfOneIdentityTakeTurnsAsOne) {
  keep_the_line_busy();
  const auto ask_as = [this](const std::string& caller, const std::string& identity, std::string_view text) {
    ExchangeRequest one = request(text);
    one.caller = caller;
    one.identity = identity;
    return ask(std::move(one));
  };
  ask_as("tcp 127.0.0.1:1", "tcp", "O:1");
  ask_as("tcp 127.0.0.1:2", "tcp", "O:2");
  ask_as("unix anna", "unix anna", "O:3");
  let_go();
  script({{"O:1\r\n", "OK\r\n"}, {"O:3\r\n", "OK\r\n"}, {"O:2\r\n", "OK\r\n"}});
  EXPECT_EQ(listener.exchanges.back().who, "tcp 127.0.0.1:2") << "for people";
}

TEST_F(LineLanesTest, TheRightIsAskedForAsTheLineIsWritten) {
  keep_the_line_busy();
  ExchangeRequest setting = request("M:1+P1000"), start = request("G:1"), tidying = request("GC:1");
  setting.motion = start.motion = tidying.motion = 7;
  tidying.tidies = true;
  ExchangeRequest speeds = request("D:1S100F1000R100");
  speeds.uses = AxisSet::of(1);
  ask(setting);
  const auto lost = ask(start);
  ask(speeds);
  ask(tidying);
  ask("O:1");
  EXPECT_THAT(listener.asked_for, IsEmpty());
  let_go();
  EXPECT_THAT(listener.asked_for, ElementsAre("M:1+P1000"));
  listener.refuses = [](const ExchangeRequest& one) { return one.command.line == "G:1"; };
  script(
      {{"M:1+P1000\r\n", "OK\r\n"}, {"D:1S100F1000R100\r\n", "OK\r\n"}, {"GC:1\r\n", "OK\r\n"}, {"O:1\r\n", "OK\r\n"}});
  EXPECT_THAT(listener.asked_for, ElementsAre("M:1+P1000", "G:1", "D:1S100F1000R100"))
      << "undoing needs no right, nor does what moves nobody's axes";
  EXPECT_FALSE(lost->written());
  EXPECT_EQ(lost->reason(), Reason::lease_lost);
}

TEST_F(LineLanesTest, TheMotionWhoseStartIsOnTheWireIsKnown) {
  ExchangeRequest setting = request("M:1+P1000"), start = request("G:1");
  setting.motion = start.motion = 7;
  ask(setting);
  EXPECT_EQ(line.starting(), 0u);
  ask(start);
  script({{"M:1+P1000\r\n", "OK\r\n"}});
  EXPECT_EQ(line.starting(), 7u);
  script({{"G:1\r\n", "OK\r\n"}});
  EXPECT_EQ(line.starting(), 0u);
}

// A refill is due in 200 ms. ?:V may take 3 + 64 bytes and twice CR LF, a millisecond each, and 5 ms that the
// controller may need: 76 ms.
class LineRefillsTest : public LineLanesTest {
 protected:
  static constexpr MotionId kPath = 7;
  LineRefillsTest() { line.keep_free(kPath, now + milliseconds(200), now); }
};

TEST_F(LineRefillsTest, WhatEndsBeforeTheRefillMayBegin) {
  pass(124);
  ask("?:V");
  script({{"?:V\r\n", "V2.00.000\r\n"}});
}

// ?:CMD may take 5 + 64 bytes and twice CR LF, and 5 ms: 78 ms, and ?:V after it 76 ms.
TEST_F(LineRefillsTest, AfterAPauseTheQuestionThatComesFirstCountsToo) {
  line.keep_free(kPath, now + milliseconds(400), now);
  pass(400 - 78 - 76);
  ask("?:V");
  script({{"?:CMD\r\n", "*IDN?\r\n"}, {"?:V\r\n", "V2.00.000\r\n"}});
}

TEST_F(LineRefillsTest, WhatEndsTooLateWithThatQuestionWaits) {
  line.keep_free(kPath, now + milliseconds(400), now);
  pass(400 - 78 - 75);
  ask("?:V");
  EXPECT_EQ(sent(), "");
}

TEST_F(LineRefillsTest, WhatMayNotEndBeforeWaitsUntilTheRefillIsLate) {
  pass(125);
  const auto question = ask("?:V");
  pass(milliseconds(75) + kRefillReservedAfterDue - milliseconds(1));
  EXPECT_EQ(sent(), "");
  pass(1);
  // The last line is now so long ago that ?:CMD comes first.
  script({{"?:CMD\r\n", "*IDN?\r\n"}, {"?:V\r\n", "V2.00.000\r\n"}});
  EXPECT_EQ(question->reply(), "V2.00.000");
}

TEST_F(LineRefillsTest, TheRefillGoesAndThenTheOthers) {
  pass(125);
  const auto question = ask("?:V");
  pass(20);
  ExchangeRequest refill = request("MP:1+P1000");
  refill.motion = kPath;
  refill.lane = Lane::path_refill;
  ask(refill);
  script({{"MP:1+P1000\r\n", "OK_D\r\n"}});
  EXPECT_FALSE(question->ended()) << "until the next refill's time is known, or none comes";
  line.release(kPath, now);
  script({{"?:V\r\n", "V2.00.000\r\n"}});
}

TEST_F(LineRefillsTest, AStopAndAHandshakeDoNotWait) {
  pass(125);
  ask("?:V");
  ask("L:1");
  script({{"L:1\r\n", "OK\r\n"}});
  ExchangeRequest handshake = request("Q:SPC");
  handshake.handshake = true;
  ask(handshake);
  script({{"Q:SPC\r\n", "P+0,P+0,P+0,0,0,0,R,R,R\r\n"}});
}

TEST_F(LineRefillsTest, ALineThatWasLostKeepsNothingFree) {
  line.keep_free(kPath, now + milliseconds(700), now);
  link_down("unplugged");
  link_up();
  script({{"*IDN?\r\n", std::string(kIdentity) + "\r\n"}});
  pass(kProbeLimit);
  open();
  pass(milliseconds(695) - kProbeLimit);
  ask("?:V");
  script({{"?:V\r\n", "V2.00.000\r\n"}});
}

TEST_F(LineRefillsTest, WhatExpiresMeanwhileIsToldWhatKeptIt) {
  pass(125);
  ExchangeRequest question = request("?:V");
  question.not_after = now + milliseconds(50);
  const auto late = ask(question);
  pass(51);
  EXPECT_EQ(late->reason(), Reason::deadline_passed);
  EXPECT_THAT(late->message(), testing::HasSubstr("the segments of a running path are so short"));
}

}  // namespace
}  // namespace axisgate::shrc203::line_lanes_test
