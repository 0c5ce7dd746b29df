#include "device/shrc203/state/motion_gate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "device/shrc203/limits.h"

namespace axisgate::shrc203::motion_gate_test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::HasSubstr;

const AxisSet kLower = AxisSet::of(1), kUpper = AxisSet::of(2);
constexpr TimePoint kLater = TimePoint{} + seconds(1000);

class MotionGateTest : public testing::Test {
 protected:
  void enter(MotionGate& gate, MotionId id, AxisSet axes, std::string caller = "a", TimePoint not_after = kLater) {
    const auto wait = [](OneShot<Result<void>> answer, MotionId number, std::vector<std::string>& news) -> Task<void> {
      const auto entered = co_await answer;
      news.push_back(std::to_string(number) + (entered ? " in" : " " + std::string(name(entered.error().reason))));
      if (!entered && entered.error().reason == Reason::deadline_passed) news.push_back(entered.error().message);
    };
    tasks_.spawn(wait(gate.enter(id, axes, caller, not_after), id, heard_));
  }
  std::vector<std::string> heard() {
    tasks_.executor().run();
    return std::exchange(heard_, {});
  }
  MotionGate gate_of(Scope scope) {
    return {tasks_, scope, [this] { return question_; }};
  }
  // Advances the time and expires waiting motions, as the controller does.
  void pass(MotionGate& gate, Duration time, const std::string& inside = {}) {
    tasks_.now_is(tasks_.now() + time);
    gate.expire([inside](AxisSet) { return inside; });
  }

  Tasks tasks_;
  std::optional<HeldQuestion> question_;
  std::vector<std::string> heard_;
};

TEST_F(MotionGateTest, OneMotionAtATimeWhereOneBusyAxisRefusesTheOthers) {
  MotionGate gate = gate_of(Scope::controller);
  enter(gate, 1, kLower);
  enter(gate, 2, kUpper);
  EXPECT_THAT(heard(), ElementsAre("1 in"));
  EXPECT_EQ(gate.waiting(), 1u);
  gate.leave(1);
  EXPECT_THAT(heard(), ElementsAre("2 in"));
}

TEST_F(MotionGateTest, DifferentAxesTogetherWhereEachIsBusyForItself) {
  MotionGate gate = gate_of(Scope::axis);
  enter(gate, 1, kLower);
  EXPECT_FALSE(gate.others_inside(1));
  enter(gate, 2, kUpper);
  enter(gate, 3, kLower);
  EXPECT_THAT(heard(), ElementsAre("1 in", "2 in"));
  EXPECT_TRUE(gate.others_inside(1));
  gate.leave(2);
  EXPECT_THAT(heard(), ElementsAre());
  gate.leave(1);
  EXPECT_THAT(heard(), ElementsAre("3 in"));
}

TEST_F(MotionGateTest, AMotionHasItsAxesToItself) {
  MotionGate each = gate_of(Scope::axis), whole = gate_of(Scope::controller);
  enter(each, 1, kLower);
  enter(each, 2, kUpper);
  enter(whole, 1, kLower);
  EXPECT_EQ(each.axes_of(1), kLower);
  EXPECT_EQ(whole.axes_of(1), kAllAxes);
  EXPECT_EQ(whole.axes_of(2), AxisSet());
}

TEST_F(MotionGateTest, CallersTakeTurns) {
  MotionGate gate = gate_of(Scope::controller);
  enter(gate, 1, kLower, "busy");
  enter(gate, 2, kLower, "busy");
  enter(gate, 3, kLower, "busy");
  enter(gate, 4, kLower, "rare");
  gate.leave(1);
  gate.leave(2);
  EXPECT_THAT(heard(), ElementsAre("1 in", "2 in", "4 in"));
}

TEST_F(MotionGateTest, WithdrawTurnsTheChosenAway) {
  MotionGate gate = gate_of(Scope::controller);
  enter(gate, 1, kLower);
  enter(gate, 2, kLower);
  enter(gate, 3, kLower);
  gate.withdraw([](MotionId id) { return id == 2; }, Problem{Reason::stopped, "by somebody", {}, {}, {}, {}});
  EXPECT_THAT(heard(), ElementsAre("1 in", "2 STOPPED"));
  gate.leave(1);
  EXPECT_THAT(heard(), ElementsAre("3 in"));
}

TEST_F(MotionGateTest, NobodyWaitsLongerThanAllowed) {
  MotionGate gate = gate_of(Scope::controller);
  enter(gate, 1, kLower);
  enter(gate, 2, kLower, "a", TimePoint{} + milliseconds(100));
  EXPECT_EQ(*gate.next_deadline(), TimePoint{} + milliseconds(100) + Duration(1));
  pass(gate, milliseconds(100));
  EXPECT_THAT(heard(), ElementsAre("1 in"));
  pass(gate, Duration(1), "axis 1 is in motion 1 (move by a)");
  EXPECT_THAT(heard(), ElementsAre("2 DEADLINE_PASSED",
                                   "the time allowed passed before the motion had its turn: axis 1 is in motion 1 "
                                   "(move by a)"));
  EXPECT_EQ(gate.next_deadline(), std::nullopt);
}

TEST_F(MotionGateTest, IsBounded) {
  MotionGate gate = gate_of(Scope::controller);
  enter(gate, 1, kLower);
  for (MotionId id = 0; id < 1024; ++id) enter(gate, 2 + id, kLower, std::to_string(id % 4));
  EXPECT_THAT(heard(), ElementsAre("1 in"));
  enter(gate, 5000, kLower, "other");
  EXPECT_THAT(heard(), ElementsAre("5000 QUEUE_FULL"));
}

TEST_F(MotionGateTest, ACallerWaitsWithAQuarterOfThatAtMost) {
  MotionGate gate = gate_of(Scope::controller);
  for (MotionId id = 1; id <= 1 + 256; ++id) enter(gate, id, kLower);
  EXPECT_THAT(heard(), ElementsAre("1 in"));
  enter(gate, 5000, kLower);
  enter(gate, 5001, kLower, "other");
  EXPECT_THAT(heard(), ElementsAre("5000 QUEUE_FULL"));
}

// Two motions with one axis each are inside, and a third that needs both axes waits.
class OvertakingTest : public MotionGateTest {
 protected:
  OvertakingTest() {
    enter(gate_, 1, kLower);
    enter(gate_, 2, kUpper);
    enter(gate_, 3, kLower | kUpper, "rare");
    EXPECT_THAT(heard(), ElementsAre("1 in", "2 in"));
  }
  MotionGate gate_ = gate_of(Scope::axis);
};

TEST_F(OvertakingTest, WhoNeedsFewerAxesGoesFirstForTwoSeconds) {
  enter(gate_, 4, kLower);
  pass(gate_, kTurnAfter - milliseconds(1));
  gate_.leave(1);
  EXPECT_THAT(heard(), ElementsAre("4 in"));
}

TEST_F(OvertakingTest, ThenNobodyOvertakes) {
  enter(gate_, 4, kLower);
  enter(gate_, 5, AxisSet::of(3));
  EXPECT_THAT(heard(), ElementsAre("5 in"));
  pass(gate_, kTurnAfter);
  gate_.leave(1);
  enter(gate_, 6, AxisSet::of(3));
  gate_.leave(5);
  EXPECT_THAT(heard(), ElementsAre("6 in")) << "of an axis that it does not need";
  gate_.leave(2);
  EXPECT_THAT(heard(), ElementsAre("3 in"));
  gate_.leave(3);
  EXPECT_THAT(heard(), ElementsAre("4 in"));
}

TEST_F(OvertakingTest, ItsOwnCallersTurnDoesNotComeTwice) {
  enter(gate_, 4, kLower | kUpper, "rare");
  pass(gate_, kTurnAfter);
  enter(gate_, 5, kLower, "new");
  gate_.leave(1);
  EXPECT_THAT(heard(), ElementsAre());
  gate_.leave(2);
  EXPECT_THAT(heard(), ElementsAre("3 in"));
  gate_.leave(3);
  EXPECT_THAT(heard(), ElementsAre("5 in")) << "the caller's second is behind one that had no turn yet";
}

TEST_F(OvertakingTest, WhoIsTurnedAwayKeepsNobodyOut) {
  enter(gate_, 4, kLower);
  pass(gate_, kTurnAfter);
  gate_.leave(1);
  EXPECT_THAT(heard(), ElementsAre());
  gate_.withdraw([](MotionId id) { return id == 3; }, Problem{Reason::stopped, "by somebody", {}, {}, {}, {}});
  EXPECT_THAT(heard(), ElementsAre("3 STOPPED", "4 in"));
}

TEST_F(OvertakingTest, WhoseTimeHasPassedMeanwhileLearnsWhoGoesFirst) {
  enter(gate_, 4, kLower, "a", tasks_.now() + seconds(3));
  pass(gate_, kTurnAfter);
  gate_.leave(1);
  pass(gate_, *gate_.next_deadline() - tasks_.now());
  EXPECT_THAT(heard(), ElementsAre("4 DEADLINE_PASSED",
                                   HasSubstr("motion 3 of rare has waited for axes 1 and 2 for 3 s and goes first")));
}

TEST_F(OvertakingTest, NorDoesOneWhoseTimeHasPassed) {
  gate_.withdraw([](MotionId id) { return id == 3; }, Problem{Reason::stopped, "by somebody", {}, {}, {}, {}});
  enter(gate_, 4, kLower | kUpper, "rare", tasks_.now() + seconds(5));
  enter(gate_, 5, kLower);
  pass(gate_, seconds(3));
  gate_.leave(1);
  EXPECT_THAT(heard(), ElementsAre("3 STOPPED"));
  pass(gate_, *gate_.next_deadline() - tasks_.now());
  EXPECT_THAT(heard(), ElementsAre("4 DEADLINE_PASSED", HasSubstr("had its turn"), "5 in"));
}

// A question that waits for motions to end keeps other motions out.
class AfterAQuestionTest : public MotionGateTest {
 protected:
  AfterAQuestionTest() {
    enter(gate_, 1, kLower);
    question_ = HeldQuestion{"?:AXIS", "rare", tasks_.now()};
    enter(gate_, 2, kLower);
    EXPECT_THAT(heard(), ElementsAre("1 in"));
  }
  MotionGate gate_ = gate_of(Scope::controller);
};

TEST_F(AfterAQuestionTest, MotionsEnterWhenItWasSent) {
  pass(gate_, kTurnAfter);
  gate_.leave(1);
  EXPECT_THAT(heard(), ElementsAre());
  EXPECT_EQ(gate_.next_deadline(), tasks_.now() + kTurnLimit);
  pass(gate_, milliseconds(300));
  question_.reset();
  gate_.admit();
  EXPECT_THAT(heard(), ElementsAre("2 in"));
}

TEST_F(AfterAQuestionTest, NotBeforeItHasWaitedForTwoSeconds) {
  pass(gate_, kTurnAfter - milliseconds(1));
  gate_.leave(1);
  EXPECT_THAT(heard(), ElementsAre("2 in"));
}

TEST_F(AfterAQuestionTest, WhatIsInsideMayStay) {
  pass(gate_, seconds(60));
  EXPECT_EQ(gate_.next_deadline(), kLater + Duration(1)) << "its limit begins when a motion could enter";
  gate_.leave(1);
  EXPECT_THAT(heard(), ElementsAre());
}

TEST_F(AfterAQuestionTest, ItsTurnHasALimit) {
  pass(gate_, kTurnAfter);
  gate_.leave(1);
  pass(gate_, kTurnLimit - milliseconds(1));
  EXPECT_THAT(heard(), ElementsAre());
  pass(gate_, milliseconds(1));
  EXPECT_THAT(heard(), ElementsAre("2 in"));
  enter(gate_, 3, kLower);
  gate_.leave(2);
  EXPECT_THAT(heard(), ElementsAre("3 in")) << "the next turn is 2 s later";
  enter(gate_, 4, kLower);
  pass(gate_, kTurnAfter);
  gate_.leave(3);
  EXPECT_THAT(heard(), ElementsAre());
}

TEST_F(AfterAQuestionTest, WhoseTimeHasPassedMeanwhileLearnsWhatItWas) {
  enter(gate_, 3, kLower, "b", tasks_.now() + seconds(3));
  pass(gate_, kTurnAfter);
  gate_.leave(1);
  pass(gate_, *gate_.next_deadline() - tasks_.now());
  EXPECT_THAT(heard(), ElementsAre("3 DEADLINE_PASSED", HasSubstr("\"?:AXIS\" of rare has waited for 3 s")));
}

}  // namespace
}  // namespace axisgate::shrc203::motion_gate_test
