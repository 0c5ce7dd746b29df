// A line that connects, exchanges one line at a time, is lost and comes back. The bytes are the manual's.
#include "tests/unit/line_fixture.h"

namespace axisgate::shrc203::line_test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class LineTest : public LineFixture {};

// Nothing from outside can cause one; if the gateway itself does, it is reported, and the line is not trusted further.
TEST_F(LineTest, AnIllegalTransitionIsReportedAndDisconnects) {
  open_and_rest();
  news();
  line.link_up(now);
  EXPECT_THAT(news(),
              ElementsAre("illegal up, port_opened", "lost: internal error: port_opened while the link was up"));
}

TEST_F(LineTest, WhatIsWrittenSaysWhetherItAsksAndWhichAxesItIsAbout) {
  open_and_rest();
  ask("?:V");
  script({{"?:V\r\n", "V2.00.000\r\n"}});
  const BytesWritten question = listener.writes.back();
  ask("L:2");
  script({{"L:2\r\n", "OK\r\n"}});
  const BytesWritten stop = listener.writes.back();
  EXPECT_TRUE(question.question);
  EXPECT_EQ(question.axes, AxisSet());
  EXPECT_FALSE(stop.question);
  EXPECT_EQ(stop.axes, AxisSet::of(2));
}

TEST_F(LineTest, AConnectAsksWhoIsThereAndThenWaitsForSilence) {
  link_up();
  script({{"*IDN?\r\n", "SIGMAKOKI,SHRC-203,2106001001,V2.00.000\r\n"}});
  pass(kSilence - milliseconds(1));
  EXPECT_THAT(news(), IsEmpty());
  pass(1);
  EXPECT_THAT(news(), ElementsAre("connected 2106001001"));
  EXPECT_THAT(listener.learnt, ElementsAre(LineLearned::What::barrier_passed));
  EXPECT_EQ(sent(), "");
}

TEST_F(LineTest, WhatComesBeforeTheIdentityIsNobodys) {
  link_up();
  script({{"*IDN?\r\n", "OK\r\nR,R,R\r\nSIGMAKOKI,SHRC-203,2106001001,V2.00.000\r\n"}});
  EXPECT_THAT(news(), ElementsAre("unexpected OK", "unexpected R,R,R"));
  pass(kSilence);
  EXPECT_THAT(news(), ElementsAre("connected 2106001001"));
}

// It may still answer what the line before had asked.
TEST_F(LineTest, ASecondConnectIsSilentForAsLongAsAnAnswerMayTake) {
  open_and_rest();
  link_down("unplugged");
  link_up();
  forget();
  receive(std::string(kIdentity) + "\r\n");
  pass(kProbeLimit - milliseconds(1));
  EXPECT_THAT(news(), IsEmpty());
  pass(1);
  EXPECT_THAT(news(), ElementsAre("connected 2106001001"));
}

TEST_F(LineTest, OnlyTheHandshakeIsSentBeforeTheLineIsOpen) {
  connect();
  const auto question = ask("?:MODE");
  EXPECT_EQ(sent(), "");
  ExchangeRequest mode = request("?:MODE");
  mode.handshake = true;
  const auto handshake = ask(mode);
  script({{"?:MODE\r\n", "HOST\r\n"}});
  EXPECT_EQ(handshake->reply(), "HOST");
  EXPECT_FALSE(question->ended()) << "the same words, and not the same right";
  open();
  script({{"?:MODE\r\n", "HOST\r\n"}});
  EXPECT_EQ(question->reply(), "HOST");
}

TEST_F(LineTest, OneExchangeAtATimeAndTheNextAtOnce) {
  open_and_rest();
  const auto first = ask("?:V"), second = ask("?:SN"), third = ask("O:1");
  EXPECT_TRUE(line.exchanging());
  EXPECT_EQ(line.queued(Lane::question), 1u);
  EXPECT_EQ(line.queued(Lane::motion), 1u);
  script({{"?:V\r\n", "V2.00.000\r\n"}, {"O:1\r\n", "OK\r\n"}, {"?:SN\r\n", "2106001001\r\n"}});
  EXPECT_EQ(first->reply(), "V2.00.000");
  EXPECT_EQ(second->reply(), "2106001001");
  EXPECT_TRUE(third->result->accepted());
  EXPECT_FALSE(line.exchanging());
}

TEST_F(LineTest, AnExchangeIsToldWithItsTimes) {
  open_and_rest();
  ask("?:V");
  pass(3);
  ask("O:1");
  pass(4);
  EXPECT_EQ(sent(), "?:V\r\n");
  receive("V2.00.000\r\n");
  EXPECT_EQ(sent(), "O:1\r\n");
  pass(6);
  receive("OK\r\n");
  ASSERT_EQ(listener.exchanges.size(), 2u);
  const ExchangeEnded &question = listener.exchanges[0], &setting = listener.exchanges[1];
  EXPECT_EQ(question.outcome, ExchangeEnded::Outcome::data);
  EXPECT_EQ(question.reply, "V2.00.000");
  EXPECT_EQ(question.latency, milliseconds(7));
  EXPECT_EQ(question.waited, milliseconds(0));
  EXPECT_EQ(setting.outcome, ExchangeEnded::Outcome::ok);
  EXPECT_EQ(setting.command, "O:");
  EXPECT_EQ(setting.who, "somebody");
  EXPECT_EQ(setting.latency, milliseconds(6));
  EXPECT_EQ(setting.waited, milliseconds(4));
  EXPECT_EQ(setting.exchange, question.exchange + 1);
}

TEST_F(LineTest, AnAnswerMayComeInPieces) {
  open_and_rest();
  const auto question = ask("?:V");
  EXPECT_EQ(sent(), "?:V\r\n");
  for (const auto* piece : {"V2.", "00", ".000\r"}) {
    EXPECT_FALSE(question->ended());
    receive(piece);
    pass(10);
  }
  EXPECT_EQ(question->reply(), "V2.00.000");
  receive("\n");
  EXPECT_THAT(news(), IsEmpty());
}

TEST_F(LineTest, APrebufferSettingIsTakenWithOKAsWellAsOK_D) {
  open_and_rest();
  const auto first = ask("MP:1+P1000"), second = ask("MP:1+P1000");
  script({{"MP:1+P1000\r\n", "OK\r\n"}, {"MP:1+P1000\r\n", "OK_D\r\n"}});
  EXPECT_EQ(first->result->reply->kind, Reply::Kind::ok);
  EXPECT_EQ(second->result->reply->kind, Reply::Kind::ok_d);
  EXPECT_TRUE(second->result->accepted());
}

// The line may have cut the command in two: its other half's NG is no answer to ?:CMD.
TEST_F(LineTest, AfterNGComesAQuestionThatNGCannotAnswer) {
  open_and_rest();
  const auto refused = ask("C:11");
  script({{"C:11\r\n", "NG\r\n"}});
  EXPECT_TRUE(refused->result->refused());
  EXPECT_FALSE(refused->result->in_doubt()) << "NG is an answer";
  const auto next = ask("O:1");
  script({{"?:CMD\r\n", "C:11\r\n"}, {"O:1\r\n", "OK\r\n"}});
  EXPECT_TRUE(next->result->accepted());
  EXPECT_THAT(news(), IsEmpty());
}

TEST_F(LineTest, AfterNGTheQuestionItselfIsEnough) {
  open_and_rest();
  ask("C:11");
  script({{"C:11\r\n", "NG\r\n"}});
  const auto before = ask("?:CMD");
  script({{"?:CMD\r\n", "C:11\r\n"}});
  EXPECT_EQ(before->reply(), "C:11");
  ask("O:1");
  script({{"O:1\r\n", "OK\r\n"}});
}

TEST_F(LineTest, AfterAPauseComesTheQuestionForTheLineBefore) {
  open_and_rest();
  ask("O:1");
  script({{"O:1\r\n", "OK\r\n"}});
  pass(kRestartMin);
  ask("O:2");
  script({{"O:2\r\n", "OK\r\n"}});
  pass(kRestartMin + milliseconds(1));
  ask("O:3");
  script({{"?:CMD\r\n", "O:2\r\n"}, {"O:3\r\n", "OK\r\n"}});
  EXPECT_THAT(news(), IsEmpty());
}

// Nobody here had asked it before: it was, perhaps, the first line that a restarted controller took.
TEST_F(LineTest, WhereARestartIsSuspectedOtherFactsComeFirst) {
  open_and_rest();
  ask("O:1");
  script({{"O:1\r\n", "OK\r\n"}});
  pass(seconds(1));
  const auto waiting = ask("O:2");
  script({{"?:CMD\r\n", "?:CMD\r\n"}});
  EXPECT_THAT(news(), ElementsAre("restart suspected"));
  EXPECT_FALSE(line.restart_only_possible());
  ask("L:1");
  script({{"L:1\r\n", "OK\r\n"}});
  ExchangeRequest fact = request("Q:SPC");
  fact.handshake = true;
  ask(fact);
  // Part of the ?:CMD may have been a question of its own, whose answer is still to come.
  script({{"?:CMD\r\n", "L:1\r\n"}, {"Q:SPC\r\n", "P+0,P+0,P+0,0,0,0,R,R,R\r\n"}});
  EXPECT_FALSE(waiting->ended());
  EXPECT_THAT(news(), IsEmpty()) << "it has been told";
  line.confirm_no_restart(now);
  script({{"O:2\r\n", "OK\r\n"}});
  EXPECT_TRUE(waiting->result->accepted());
  EXPECT_THAT(listener.learnt, ElementsAre(LineLearned::What::same_controller));
}

TEST_F(LineTest, BehindALateAnswerARestartIsPossibleAndNoMore) {
  open_and_rest();
  const auto question = ask("?:V");
  EXPECT_EQ(sent(), "?:V\r\n");
  // The line and the longest answer take 69 ms.
  pass(milliseconds(69) + kRestartMin + milliseconds(1));
  receive("V2.00.000\r\n");
  EXPECT_EQ(question->reply(), "V2.00.000");
  EXPECT_THAT(news(), ElementsAre("restart suspected"));
  EXPECT_TRUE(line.restart_only_possible());
  line.confirm_no_restart(now);
  EXPECT_FALSE(line.restart_only_possible());
}

// 16 bytes of the 100 ms are the line's; a stop's answer may be that of a ?:CMD before it.
TEST_F(LineTest, TheTurnaroundIsLearntFromExchangesButNotFromStops) {
  open_and_rest();
  ask("?:V");
  EXPECT_EQ(sent(), "?:V\r\n");
  pass(100);
  receive("V2.00.000\r\n");
  EXPECT_EQ(line.timing().longest_turnaround(), milliseconds(84));
  ask("L:1");
  EXPECT_EQ(sent(), "L:1\r\n");
  pass(200);
  receive("OK\r\n");
  EXPECT_EQ(line.timing().longest_turnaround(), milliseconds(84));
}

// P:OFF writes to a memory, for 5 s at most (manual 112)).
TEST_F(LineTest, WhatSavesMayTakeLong) {
  open_and_rest();
  const auto saving = ask("P:OFF");
  sent();
  pass(seconds(5));
  receive("OK\r\n");
  EXPECT_TRUE(saving->result->accepted());
  EXPECT_THAT(news(), IsEmpty());
}

TEST_F(LineTest, AnotherProgramOnTheLineEndsIt) {
  open_and_rest();
  ask("O:1");
  script({{"O:1\r\n", "OK\r\n"}});
  pass(seconds(1));
  const auto waiting = ask("O:2");
  script({{"?:CMD\r\n", "M:1+P1000\r\n"}});
  EXPECT_THAT(news(), ElementsAre(HasSubstr("lost: the controller was last sent \"M:1+P1000\", and not from here")));
  EXPECT_FALSE(waiting->written());
  EXPECT_EQ(waiting->reason(), Reason::link_down);
  EXPECT_THAT(link.reopened, ElementsAre(milliseconds(250)));
}

TEST_F(LineTest, ALineLostInFlightLeavesItsOutcomeUnknown) {
  open_and_rest();
  const auto in_flight = ask("G:1"), waiting = ask("?:V"), stop = ask("L:1");
  EXPECT_EQ(sent(), "G:1\r\n");
  link_down("unplugged");
  EXPECT_TRUE(in_flight->result->in_doubt());
  EXPECT_EQ(in_flight->reason(), Reason::link_down);
  EXPECT_EQ(in_flight->message(), "the line to the controller is down: unplugged");
  EXPECT_FALSE(waiting->written());
  EXPECT_EQ(waiting->reason(), Reason::link_down);
  ASSERT_EQ(listener.exchanges.size(), 1u);
  EXPECT_EQ(listener.exchanges[0].outcome, ExchangeEnded::Outcome::link_lost);
  EXPECT_EQ(listener.exchanges[0].line, "G:1");
  EXPECT_THAT(news(), ElementsAre("lost: unplugged"));
  EXPECT_FALSE(line.exchanging());
  EXPECT_FALSE(stop->written()) << "who wants it, asks again at the next connect";
}

TEST_F(LineTest, NothingWaitsForALineThatIsDown) {
  open_and_rest();
  link_down("unplugged");
  for (const char* text : {"?:V", "L:1"}) {
    const auto refused = ask(text);
    EXPECT_FALSE(refused->written()) << text;
    EXPECT_EQ(refused->reason(), Reason::link_down) << text;
  }
}

TEST_F(LineTest, OpenStopsGoBeforeTheFirstProbe) {
  open_and_rest();
  link_down("unplugged");
  line.open_at_once(now);
  line.open_at_once(now);
  EXPECT_THAT(link.reopened, ElementsAre(milliseconds(250), Duration::zero())) << "at once, and once";
  listener.open_stops = {"L:1", "L:2"};
  link_up();
  EXPECT_EQ(sent(), "L:1\r\nL:2\r\n*IDN?\r\n");
  listener.open_stops = {"L:W"};
  receive("OK\r\n");
  EXPECT_EQ(sent(), "L:W\r\n?:CMD\r\n") << "before anything else, and the barrier begins again";
  listener.open_stops = {};
  receive("OK\r\n");
  EXPECT_EQ(sent(), "");
}

TEST_F(LineTest, APortIsReopenedWithoutGrowingPausesWhileAStopIsOpen) {
  open_and_rest();
  listener.stop_open = true;
  for (int loss = 0; loss < 3; ++loss) link_down("unplugged");
  listener.stop_open = false;
  for (int loss = 0; loss < 3; ++loss) link_down("unplugged");
  EXPECT_THAT(link.reopened, ElementsAre(milliseconds(250), milliseconds(250), milliseconds(250), milliseconds(250),
                                         milliseconds(500), milliseconds(1000)));
}

// Half of what the line carries in a second is 500 bytes.
TEST_F(LineTest, H62_ADeviceThatSendsWithoutEndIsShutOut) {
  open_and_rest();
  const std::string noise(100, 'x');
  for (int i = 0; i < 4; ++i) receive(noise + "\r\n");
  EXPECT_EQ(line.state().phase(), LinkPhase::up);
  pass(seconds(1));
  for (int i = 0; i < 4; ++i) receive(noise + "\r\n");
  EXPECT_EQ(line.state().phase(), LinkPhase::up) << "the second before does not count";
  receive(noise + "\r\n");
  EXPECT_EQ(line.state().phase(), LinkPhase::babbling);
  EXPECT_THAT(link.reopened, ElementsAre(milliseconds(250)));
  link_up();
  forget();
  EXPECT_EQ(line.state().phase(), LinkPhase::listening);
  receive(std::string(2000, 'x'));
  EXPECT_EQ(line.state().phase(), LinkPhase::babbling);
  EXPECT_THAT(link.reopened, ElementsAre(milliseconds(250), milliseconds(500)));
}

TEST_F(LineTest, AnswersAreNoFlood) {
  open_and_rest();
  for (int i = 0; i < 200; ++i) {
    ask("?:V");
    script({{"?:V\r\n", "V2.00.000\r\n"}});
  }
  EXPECT_EQ(line.state().phase(), LinkPhase::up);
}

TEST_F(LineTest, ThreeProbesWithoutAnswerCloseTheLine) {
  link_up();
  for (int probe = 1; probe <= 3; ++probe) {
    EXPECT_EQ(sent(), "*IDN?\r\n");
    EXPECT_THAT(link.reopened, IsEmpty());
    pass(kProbeLimit);
  }
  EXPECT_EQ(sent(), "");
  EXPECT_THAT(listener.limits, ElementsAre("probe", "probe", "probe"));
  EXPECT_THAT(news(), ElementsAre("lost: no answer to three probes"));
  EXPECT_THAT(link.reopened, ElementsAre(milliseconds(250)));
}

TEST_F(LineTest, TheWaitDoublesUpToFiveSecondsAndBeginsAnewOnceTheLineIsOpen) {
  for (int i = 0; i < 7; ++i) {
    link_up();
    pass(3 * kProbeLimit);
  }
  EXPECT_THAT(link.reopened, ElementsAre(milliseconds(250), milliseconds(500), seconds(1), seconds(2), seconds(4),
                                         seconds(5), seconds(5)));
  link.reopened.clear();
  link_up();
  receive(std::string(kIdentity) + "\r\n");
  pass(kProbeLimit);
  link_down("an identity is not enough");
  link_up();
  receive(std::string(kIdentity) + "\r\n");
  pass(kProbeLimit);
  open();
  link_down("unplugged");
  EXPECT_THAT(link.reopened, ElementsAre(seconds(5), milliseconds(250)));
  forget();
}

TEST_F(LineTest, APortThatDoesNotOpenIsTriedEverMoreSlowly) {
  link_down("no such device");
  link_down("no such device");
  link_down("no such device");
  EXPECT_THAT(link.reopened, ElementsAre(milliseconds(250), milliseconds(500), seconds(1)));
  EXPECT_THAT(news(), ElementsAre("lost: no such device", "lost: no such device", "lost: no such device"));
}

// Of the line before: nothing of it may become part of an answer.
TEST_F(LineTest, HalfALineIsGoneWithTheLine) {
  open_and_rest();
  ask("?:V");
  receive("V2.0");
  link_down("unplugged");
  link_up();
  forget();
  receive(std::string(kIdentity) + "\r\n");
  pass(kProbeLimit);
  EXPECT_THAT(news(), ElementsAre("connected 2106001001"));
}

}  // namespace
}  // namespace axisgate::shrc203::line_test
