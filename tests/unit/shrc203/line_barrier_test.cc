// The line's barrier after a missing or impossible answer, from doubt to certainty.
#include "tests/unit/shrc203/line_fixture.h"

namespace axisgate::shrc203::line_barrier_test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string kIdentityLine = std::string(kIdentity) + "\r\n";

class LineBarrierTest : public LineFixture {
 protected:
  LineBarrierTest() { open_and_rest(); }
  // Sends `text` and lets its time limit pass; a ?:SN before it gives ?:CMD another line to report.
  AskedPtr asked_and_late(std::string_view text) {
    ask("?:SN");
    script({{"?:SN\r\n", "2106001001\r\n"}});
    auto late = ask(text);
    EXPECT_EQ(sent(), std::string(text) + "\r\n");
    pass(limit_of(text));
    return late;
  }
};

TEST_F(LineBarrierTest, ALateAnswerIsDoubtedUntilTheControllerTellsWhatItReceived) {
  const auto late = asked_and_late("G:1");
  EXPECT_THAT(news(), ElementsAre("barrier: \"G:1\" was not answered in time"));
  EXPECT_THAT(listener.limits, ElementsAre("reply"));
  EXPECT_EQ(listener.exchanges.back().outcome, ExchangeEnded::Outcome::timed_out);
  const auto next = ask("O:1");
  script({{"?:CMD\r\n", "G:1\r\n"}, {"*IDN?\r\n", kIdentityLine}});
  EXPECT_TRUE(line.exchanging());
  pass(kSilence - milliseconds(1));
  EXPECT_FALSE(late->ended());
  EXPECT_EQ(sent(), "");
  pass(1);
  EXPECT_TRUE(late->result->in_doubt());
  EXPECT_EQ(late->reason(), Reason::reply_timed_out);
  EXPECT_EQ(late->message(), "\"G:1\" was not answered in time; the controller had received it");
  EXPECT_THAT(news(), ElementsAre("passed"));
  // The silence was also a pause, so ?:CMD comes first.
  script({{"?:CMD\r\n", "*IDN?\r\n"}, {"O:1\r\n", "OK\r\n"}});
  EXPECT_TRUE(next->result->accepted());
}

TEST_F(LineBarrierTest, AnotherLineBeforeShowsThatItWasNotTaken) {
  const auto late = asked_and_late("G:1");
  script({{"?:CMD\r\n", "?:SN\r\n"}, {"*IDN?\r\n", kIdentityLine}});
  pass(kSilence);
  EXPECT_TRUE(late->result->in_doubt()) << "it may still be on its way";
  EXPECT_EQ(late->message(), "\"G:1\" was not answered in time; the controller had not received it");
}

TEST_F(LineBarrierTest, TheTimeLimitIsThatOfTheLineAndTheLongestAnswer) {
  ask("?:V");
  EXPECT_EQ(sent(), "?:V\r\n");
  pass(milliseconds(568));
  EXPECT_EQ(sent(), "");
  EXPECT_THAT(news(), IsEmpty());
  pass(1);
  EXPECT_EQ(sent(), "?:CMD\r\n");
}

// A repeated probe is answered with the probe before it.
TEST_F(LineBarrierTest, ARepeatedProbeTellsNothingOfTheLine) {
  const auto late = asked_and_late("G:1");
  script({{"?:CMD\r\n", ""}});
  pass(kProbeLimit);
  script({{"?:CMD\r\n", "?:CMD\r\n"}, {"*IDN?\r\n", kIdentityLine}});
  EXPECT_EQ(line.outstanding(), 1);
  pass(2 * kSilence);
  EXPECT_EQ(late->message(), "\"G:1\" was not answered in time");
  EXPECT_EQ(line.outstanding(), 0) << "answers come in order, so that of the first ?:CMD is lost";
}

TEST_F(LineBarrierTest, WhatCannotBeTheAnswerIsGarbage) {
  const auto question = ask("?:V");
  script({{"?:V\r\n", "OK\r\n"}, {"?:CMD\r\n", "?:V\r\n"}, {"*IDN?\r\n", kIdentityLine}});
  pass(kSilence);
  EXPECT_TRUE(question->result->in_doubt());
  EXPECT_EQ(question->reason(), Reason::line_fault);
  EXPECT_EQ(question->message(),
            "\"?:V\" was answered by \"OK\", which cannot be its answer; the controller had received it");
  EXPECT_EQ(question->result->problem->wire_reply, "OK");
  EXPECT_EQ(listener.exchanges.back().outcome, ExchangeEnded::Outcome::garbled);
}

TEST_F(LineBarrierTest, AnAnswerThatWasCutForItsLengthIsGarbage) {
  const auto question = ask("?:V");
  sent();
  receive("V" + std::string(LineFramer::kLineBytesMax, '0') + "\r\n");
  EXPECT_EQ(sent(), "?:CMD\r\n");
  EXPECT_FALSE(question->ended());
}

// Manual 3.: "contains NULL of ASCII code or non-ASCII code characters", which no line of the gateway does.
TEST_F(LineBarrierTest, NG_ITellsThatTheLineIsDisturbed) {
  const auto setting = ask("O:1");
  script({{"O:1\r\n", "NG_I\r\n"}, {"?:CMD\r\n", "O:1\r\n"}, {"*IDN?\r\n", kIdentityLine}});
  pass(kSilence);
  EXPECT_EQ(setting->reason(), Reason::line_fault);
  EXPECT_EQ(setting->reply(), "NG_I");
  EXPECT_FALSE(setting->result->accepted());
  EXPECT_EQ(listener.exchanges.back().outcome, ExchangeEnded::Outcome::ng_i);
}

TEST_F(LineBarrierTest, ALateAnswerInTheBarrierIsNobodysAndBeginsTheSilenceAnew) {
  const auto late = asked_and_late("O:1");
  news();
  script({{"?:CMD\r\n", "O:1\r\n"}, {"*IDN?\r\n", kIdentityLine}});
  pass(100);
  receive("OK\r\n");
  EXPECT_THAT(news(), ElementsAre("unexpected OK"));
  pass(kSilence - milliseconds(1));
  EXPECT_FALSE(late->ended());
  pass(1);
  EXPECT_TRUE(late->ended());
}

TEST_F(LineBarrierTest, HalfALineBeginsTheSilenceAnew) {
  const auto late = asked_and_late("O:1");
  script({{"?:CMD\r\n", "O:1\r\n"}, {"*IDN?\r\n", kIdentityLine}});
  pass(100);
  receive("O");
  pass(kSilence - milliseconds(1));
  EXPECT_FALSE(late->ended());
  pass(1);
  EXPECT_TRUE(late->ended());
}

// Otherwise the half answer would join with the answer to the first probe.
TEST_F(LineBarrierTest, HalfAnAnswerIsDroppedAtTheTimeLimit) {
  ask("?:V");
  sent();
  receive("V2.0");
  pass(limit_of("?:V"));
  EXPECT_THAT(news(), ElementsAre("unexpected (a line that did not end)", "barrier: \"?:V\" was not answered in time"));
  script({{"?:CMD\r\n", "?:V\r\n"}, {"*IDN?\r\n", ""}});
}

TEST_F(LineBarrierTest, ThreeProbesWithoutAnswerCloseTheLine) {
  const auto late = asked_and_late("G:1"), waiting = ask("?:V");
  for (int probe = 1; probe <= 3; ++probe) {
    script({{"?:CMD\r\n", ""}});
    EXPECT_FALSE(late->ended());
    pass(kProbeLimit - milliseconds(5));
  }
  EXPECT_TRUE(late->result->in_doubt());
  EXPECT_EQ(late->message(), "\"G:1\" was not answered in time") << "and not that the line is down";
  EXPECT_EQ(waiting->reason(), Reason::link_down);
  EXPECT_FALSE(waiting->written());
  EXPECT_THAT(news(), ElementsAre("barrier: \"G:1\" was not answered in time", "lost: no answer to three probes"));
  EXPECT_THAT(link.reopened, ElementsAre(milliseconds(250)));
  EXPECT_FALSE(line.exchanging());
  EXPECT_EQ(line.outstanding(), 3);
  link_up();
  EXPECT_EQ(sent(), "*IDN?\r\n");
  EXPECT_EQ(line.outstanding(), 0) << "the line before has taken them along";
}

TEST_F(LineBarrierTest, AnswersToProbesThatWereGivenUpAreSwallowedLater) {
  asked_and_late("O:1");
  script({{"?:CMD\r\n", "O:1\r\n"}, {"*IDN?\r\n", ""}});
  pass(kProbeLimit - milliseconds(5));
  EXPECT_EQ(line.outstanding(), 1);
  script({{"*IDN?\r\n", kIdentityLine}});
  pass(kSilence);
  line.confirm_no_restart(now);
  news();
  const auto question = ask("?:V");
  script({{"?:V\r\n", kIdentityLine + "V2.00.000\r\n"}});
  EXPECT_EQ(question->reply(), "V2.00.000");
  EXPECT_EQ(line.outstanding(), 0);
  receive(kIdentityLine);
  EXPECT_THAT(news(), ElementsAre("unexpected SIGMAKOKI,SHRC-203,2106001001,V2.00.000")) << "no more than are owed";
}

// With an identity outstanding, NG may refuse the *IDN? or the line in flight.
TEST_F(LineBarrierTest, NGIsNotBelievedWhileAnIdentityIsOwed) {
  asked_and_late("O:1");
  script({{"?:CMD\r\n", "O:1\r\n"}, {"*IDN?\r\n", ""}});
  pass(kProbeLimit - milliseconds(5));
  script({{"*IDN?\r\n", kIdentityLine}});
  pass(kSilence);
  line.confirm_no_restart(now);
  const auto setting = ask("O:2");
  script({{"O:2\r\n", "NG\r\n"}, {"?:CMD\r\n", "O:2\r\n"}, {"*IDN?\r\n", kIdentityLine}});
  EXPECT_EQ(line.outstanding(), 0);
  pass(kSilence);
  EXPECT_TRUE(setting->result->in_doubt());
  EXPECT_FALSE(setting->result->refused());
}

TEST_F(LineBarrierTest, AStopIsWrittenInTheBarrierAtOnceAndTheBarrierBeginsAnew) {
  const auto late = asked_and_late("G:1");
  EXPECT_EQ(sent(), "?:CMD\r\n");
  pass(10);
  const auto stop = ask("L:1");
  EXPECT_EQ(sent(), "L:1\r\n*IDN?\r\n");
  EXPECT_TRUE(stop->result->in_doubt()) << "whose answer is whose cannot be told";
  EXPECT_EQ(stop->reason(), Reason::outcome_unknown);
  receive("G:1\r\nOK\r\n");
  receive(kIdentityLine);
  pass(kSilence);
  EXPECT_EQ(late->message(), "\"G:1\" was not answered in time") << "the stop was the last line, and not G:1";
}

// An identity before the stop's own answer passes no barrier.
TEST_F(LineBarrierTest, AnIdentityAskedForBeforeTheStopDoesNotPass) {
  asked_and_late("G:1");
  script({{"?:CMD\r\n", "G:1\r\n"}});
  ask("L:1");
  EXPECT_EQ(sent(), "*IDN?\r\nL:1\r\n?:CMD\r\n");
  news();
  receive(kIdentityLine);
  pass(2 * kSilence);
  EXPECT_THAT(news(), IsEmpty());
  receive("OK\r\nL:1\r\n");
  EXPECT_EQ(sent(), "*IDN?\r\n");
  receive(kIdentityLine);
  pass(4 * kSilence);
  EXPECT_THAT(news(), testing::Contains("passed"));
  EXPECT_EQ(line.outstanding(), 0);
}

TEST_F(LineBarrierTest, AStopThatWaitsForAnAnswerIsWrittenAsTheBarrierBegins) {
  const auto setting = ask("O:1");
  const auto stop = ask("L:1");
  script({{"O:1\r\n", "R,R\r\n"}, {"?:CMD\r\nL:1\r\n*IDN?\r\n", ""}});
  EXPECT_FALSE(setting->ended());
  EXPECT_TRUE(stop->written());
}

TEST_F(LineBarrierTest, AStopWhoseOwnAnswerIsGarbageIsInDoubt) {
  const auto stop = ask("L:1");
  script({{"L:1\r\n", "O\r\n"}, {"?:CMD\r\n", "L:1\r\n"}, {"*IDN?\r\n", kIdentityLine}});
  pass(kSilence);
  EXPECT_EQ(stop->reason(), Reason::line_fault);
  EXPECT_THAT(stop->message(), EndsWith("; the controller had received it"));
}

// A repeated ?:CMD after a pause proves nothing: the controller may have restarted before it.
TEST_F(LineBarrierTest, TheQuestionBehindAPauseIsDoubtedLikeAnyOther) {
  ask("O:1");
  script({{"O:1\r\n", "OK\r\n"}});
  pass(seconds(1));
  const auto waiting = ask("O:2");
  script({{"?:CMD\r\n", "1M,:\r\n"}, {"?:CMD\r\n", "?:CMD\r\n"}, {"*IDN?\r\n", kIdentityLine}});
  pass(kSilence);
  EXPECT_THAT(news(), ElementsAre(HasSubstr("barrier: \"?:CMD\" was answered by"), "restart suspected", "passed"));
  EXPECT_FALSE(waiting->ended());
}

// A controller this slow may have more to send.
TEST_F(LineBarrierTest, TheSilenceIsTwiceWhatTheIdentityTook) {
  const auto late = asked_and_late("O:1");
  script({{"?:CMD\r\n", "O:1\r\n"}});
  EXPECT_EQ(sent(), "*IDN?\r\n");
  pass(200);
  receive(kIdentityLine);
  pass(399);
  EXPECT_FALSE(late->ended());
  pass(1);
  EXPECT_TRUE(late->ended());
}

TEST_F(LineBarrierTest, NothingIsSentWhileHalfALineIsComingIn) {
  receive("R");
  const auto question = ask("?:V");
  EXPECT_EQ(sent(), "");
  pass(49);
  EXPECT_EQ(sent(), "");
  pass(1);
  EXPECT_EQ(sent(), "?:V\r\n");
  EXPECT_THAT(news(), ElementsAre("unexpected (a line that did not end)"));
}

TEST_F(LineBarrierTest, WhatIsHalfInIsSoonComplete) {
  receive("R");
  const auto question = ask("?:V");
  pass(20);
  receive(",R,R\r\n");
  EXPECT_THAT(news(), ElementsAre("unexpected R,R,R"));
  EXPECT_EQ(sent(), "?:V\r\n");
}

}  // namespace
}  // namespace axisgate::shrc203::line_barrier_test
