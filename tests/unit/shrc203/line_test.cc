// A line that connects and exchanges one line at a time. The bytes are from the manual.
#include "tests/unit/shrc203/line_fixture.h"

namespace axisgate::shrc203::line_test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class LineTest : public LineFixture {};

// Only a fault of the gateway can cause an illegal transition; it is reported, and the line is no longer trusted.
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

// The device may still answer a question from before the disconnect.
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

// The line may have cut the command in two: the other half's NG is no answer to ?:CMD.
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

// The gateway had not sent ?:CMD before, so it may be the first line that a restarted controller received.
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
  // Part of the ?:CMD may have been received as a separate question, whose answer is still to come.
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

// The line itself takes 16 ms of the 100 ms; a stop's answer may be that of a ?:CMD before it.
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

}  // namespace
}  // namespace axisgate::shrc203::line_test
