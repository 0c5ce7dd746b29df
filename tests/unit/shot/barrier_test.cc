#include "device/shot/line/barrier.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "device/shrc203/command/command_table.h"

namespace axisgate::shot::barrier_test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;

constexpr const char* kIdentity = "SIGMAKOKI,SHRC-203,2106001001,V2.00.000";

TimePoint at(int ms) { return TimePoint{} + milliseconds(ms); }

class BarrierTest : public testing::Test {
 protected:
  Barrier barrier(std::string in_doubt) {
    return Barrier(
        shrc203::model(), std::move(in_doubt), {milliseconds(500), milliseconds(50)}, owed,
        [](const Identity& identity) { return identity.serial_number == "2106001001"; },
        [this](std::string_view line, TimePoint) { lines.emplace_back(line); });
  }
  std::vector<std::string> lines;
  OutstandingAnswers owed;
};

TEST_F(BarrierTest, EchoThenIdentityThenSilence) {
  auto it = barrier("G:1");
  it.start(at(0));
  EXPECT_TRUE(it.on_line("G:1", at(10)));
  EXPECT_TRUE(it.on_line(kIdentity, at(20)));
  EXPECT_THAT(lines, ElementsAre("?:CMD", "*IDN?"));
  EXPECT_EQ(it.next_deadline(), at(70));
  it.advance(at(69));
  EXPECT_EQ(it.state(), Barrier::State::probing);
  it.advance(at(70));
  EXPECT_EQ(it.state(), Barrier::State::passed);
  EXPECT_EQ(it.received(), true);
  EXPECT_EQ(it.identity()->serial_number, "2106001001");
  EXPECT_EQ(owed.echoes + owed.identities, 0);
}

TEST_F(BarrierTest, AnotherEchoTellsThatTheLineWasNotReceived) {
  auto it = barrier("G:1");
  it.start(at(0));
  EXPECT_TRUE(it.on_line("M:1+P1000", at(10)));
  EXPECT_EQ(it.received(), false);
}

// One damaged byte can look like another controller's identity, so only the same answer twice is believed.
TEST_F(BarrierTest, AnIdentityOfAnotherControllerIsAskedForAgain) {
  constexpr const char* kOther = "SIGMAKOKI,SHRC-203,2106001009,V2.00.000";
  constexpr const char* kThird = "SIGMAKOKI,SHRC-203,3106001001,V2.00.000";
  struct Case {
    std::vector<const char*> answers;
    const char* believed;  // null if no identity is believed
  };
  for (const Case& one : {Case{{kOther, kIdentity}, "2106001001"}, Case{{kOther, kOther}, "2106001009"},
                          Case{{kOther, kThird, kThird}, "3106001001"}, Case{{kOther, kThird, kOther}, nullptr}}) {
    lines.clear();
    auto it = barrier("");
    it.start(at(0));
    int ms = 0;
    for (const char* answer : one.answers) it.on_line(answer, at(ms += 10));
    EXPECT_EQ(lines.size(), one.answers.size());
    it.advance(at(ms + 100));
    EXPECT_EQ(it.state(), one.believed ? Barrier::State::passed : Barrier::State::failed);
    EXPECT_EQ(it.identity() ? it.identity()->serial_number : "none", one.believed ? one.believed : "none");
  }
}

// An unreadable first answer is no evidence of another controller.
TEST_F(BarrierTest, AnUnreadableIdentityIsAskedForAgain) {
  auto it = barrier("");
  it.start(at(0));
  EXPECT_FALSE(it.on_line("SIGMAKOKI,SHRC-203,21060x1001,V2.00.000", at(10)));
  it.advance(at(500));
  EXPECT_EQ(lines.size(), 2u);
  EXPECT_TRUE(it.on_line(kIdentity, at(510)));
}

TEST_F(BarrierTest, AfterAConnectOnlyTheIdentityIsAsked) {
  auto it = barrier("");
  it.start(at(0));
  EXPECT_THAT(lines, ElementsAre("*IDN?"));
  it.on_line(kIdentity, at(10));
  it.advance(at(60));
  EXPECT_EQ(it.state(), Barrier::State::passed);
  EXPECT_EQ(it.received(), std::nullopt);
}

TEST_F(BarrierTest, LateAnswersAreNotThoseOfTheProbes) {
  auto it = barrier("D:1S100F1000R100");
  it.start(at(0));
  EXPECT_FALSE(it.on_line("OK", at(10)));
  EXPECT_FALSE(it.on_line("P+0,P+0,P+0,1,1,1,R,R,R", at(11)));
  EXPECT_THAT(lines, ElementsAre("?:CMD"));
  it.on_line("D:1S100F1000R100", at(20));
  EXPECT_FALSE(it.on_line("OK", at(21)));
  EXPECT_FALSE(it.on_line("SIGMAKOKI,SHRC-203,2106001001", at(22))) << "three fields";
  EXPECT_FALSE(it.identity());
}

TEST_F(BarrierTest, WhatComesInDuringTheSilenceBeginsItAnew) {
  auto it = barrier("");
  it.start(at(0));
  it.on_line(kIdentity, at(10));
  EXPECT_FALSE(it.on_line("OK", at(50)));
  it.advance(at(60));
  EXPECT_EQ(it.state(), Barrier::State::probing);
  it.advance(at(100));
  EXPECT_EQ(it.state(), Barrier::State::passed);
}

TEST_F(BarrierTest, ALineThatNeverFallsSilentFails) {
  auto it = barrier("");
  it.start(at(0));
  it.on_line(kIdentity, at(10));
  int now = 10;
  while (it.state() == Barrier::State::probing && now < 20000) {
    it.on_line("OK", at(now += 40));
    it.advance(at(now));
  }
  it.advance(at(now += 50));
  EXPECT_EQ(it.state(), Barrier::State::failed);
  EXPECT_GE(now, 5000);
  EXPECT_LT(now, 5200);
}

TEST_F(BarrierTest, ThreeProbesAndNoMore) {
  auto it = barrier("G:1");
  it.start(at(0));
  it.advance(at(499));
  EXPECT_THAT(lines, ElementsAre("?:CMD"));
  it.advance(at(500));
  it.advance(at(1000));
  EXPECT_THAT(lines, ElementsAre("?:CMD", "?:CMD", "?:CMD"));
  EXPECT_EQ(it.state(), Barrier::State::probing);
  it.advance(at(1500));
  EXPECT_EQ(it.state(), Barrier::State::failed);
  EXPECT_EQ(lines.size(), 3u);
  EXPECT_EQ(owed.echoes, 3);
}

// A repeated ?:CMD is answered with the ?:CMD before it, which shows nothing about the line in doubt.
TEST_F(BarrierTest, RepeatedProbesAreOwedAndSwallowed) {
  auto it = barrier("G:1");
  it.start(at(0));
  it.advance(at(500));
  EXPECT_EQ(owed.echoes, 1);
  EXPECT_TRUE(it.on_line("?:CMD", at(510)));
  EXPECT_EQ(it.received(), std::nullopt);
  EXPECT_TRUE(it.on_line("G:1", at(520))) << "the answer to the first probe";
  EXPECT_EQ(owed.echoes, 0);
  EXPECT_FALSE(it.identity());
}

TEST_F(BarrierTest, AnOwedIdentityIsSwallowedAfterwards) {
  auto it = barrier("");
  it.start(at(0));
  it.advance(at(500));
  it.on_line(kIdentity, at(510));
  EXPECT_EQ(owed.identities, 1);
  EXPECT_TRUE(it.on_line(kIdentity, at(520)));
  EXPECT_EQ(owed.identities, 0);
  EXPECT_FALSE(settle_outstanding(shrc203::model(), owed, kIdentity)) << "no more than is owed";
}

// Two stops in one barrier: a late answer to the ?:CMD from before the first stop says nothing about the second.
TEST_F(BarrierTest, AQuestionAskedBeforeTheStopDoesNotStandForTheOneBehindIt) {
  auto it = barrier("?:EP");
  it.start(at(0));
  it.restart(at(10));
  it.restart(at(20));
  EXPECT_THAT(lines, ElementsAre("?:CMD", "*IDN?", "?:CMD"));
  EXPECT_TRUE(it.on_line("?:EP", at(30)));
  EXPECT_EQ(it.echo(), "?:EP");
  EXPECT_EQ(lines.size(), 3u);
  EXPECT_TRUE(it.on_line(kIdentity, at(40)));
  EXPECT_TRUE(it.on_line("*IDN?", at(41)));
  EXPECT_THAT(lines, ElementsAre("?:CMD", "*IDN?", "?:CMD", "*IDN?"));
}

// The first identities to arrive were requested before the stop, whose OK is still missing, even if two arrive.
TEST_F(BarrierTest, AnIdentityAskedForBeforeTheStopDoesNotPass) {
  auto it = barrier("");
  it.start(at(0));
  it.restart(at(100));
  EXPECT_THAT(lines, ElementsAre("*IDN?", "?:CMD"));
  EXPECT_TRUE(it.on_line(kIdentity, at(110)));
  EXPECT_FALSE(it.on_line(kIdentity, at(111)));
  it.advance(at(300));
  EXPECT_EQ(it.state(), Barrier::State::probing);
  EXPECT_FALSE(it.on_line("OK", at(310)));
  EXPECT_TRUE(it.on_line("*IDN?", at(310)));
  EXPECT_EQ(it.received(), std::nullopt);
  EXPECT_EQ(it.echo(), std::nullopt);
  EXPECT_THAT(lines, ElementsAre("*IDN?", "?:CMD", "*IDN?"));
  EXPECT_TRUE(it.on_line(kIdentity, at(320)));
  it.advance(at(320 + 50 - 1));
  EXPECT_EQ(it.state(), Barrier::State::probing);
  it.advance(at(320 + 50));
  EXPECT_EQ(it.state(), Barrier::State::passed);
}

TEST_F(BarrierTest, HalfALineBeginsTheSilenceAnew) {
  auto it = barrier("G:1");
  it.start(at(0));
  EXPECT_TRUE(it.on_line("G:1", at(10)));
  EXPECT_TRUE(it.on_line(kIdentity, at(20)));
  it.on_half_line(at(50));
  it.advance(at(99));
  EXPECT_EQ(it.state(), Barrier::State::probing);
  it.advance(at(100));
  EXPECT_EQ(it.state(), Barrier::State::passed);
}

TEST_F(BarrierTest, AStopInBetweenBeginsItAnewWithoutTheEcho) {
  auto it = barrier("G:1");
  it.start(at(0));
  it.restart(at(100));
  EXPECT_THAT(lines, ElementsAre("?:CMD", "*IDN?"));
  EXPECT_EQ(owed.echoes, 1);
  EXPECT_TRUE(it.on_line("G:1", at(110)));
  it.on_line(kIdentity, at(120));
  it.advance(at(170));
  EXPECT_EQ(it.state(), Barrier::State::passed);
  EXPECT_EQ(it.received(), std::nullopt);
}

}  // namespace
}  // namespace axisgate::shot::barrier_test
