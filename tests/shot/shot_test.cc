// A second controller in SHOT/FC mode, with two axes, over the line of the family.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shot/rig.h"

namespace axisgate::shot2 {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(Shot2, ComesUpWithItsTwoAxes) {
  Rig rig;
  EXPECT_EQ(rig.controller.state().link, LinkState::up);
  EXPECT_EQ(rig.controller.state().model, "SHOT-2");
  EXPECT_THAT(rig.controller.state().controllable().list(), ElementsAre(1, 2));
  EXPECT_THAT(std::vector<std::string>(rig.commands.begin(), rig.commands.begin() + 2),
              ElementsAre("*IDN?\r\n", "Q:SPC\r\n"));
}

TEST(Shot2, MovesBothAxesAndTakesTheirNumbersForCompletions) {
  Rig rig;
  const MotionId id = rig.move({{1, 1000}, {2, -20}});
  EXPECT_EQ(rig.outcome(id), MotionState::succeeded);
  EXPECT_EQ(rig.written("AP:A+P1000-P20"), 1);
  EXPECT_EQ(rig.written("G:A"), 1);
  EXPECT_EQ(rig.unit.position(1), 1000);
  EXPECT_EQ(rig.unit.position(2), -20);
  EXPECT_EQ(rig.seen<CompletionSeen>(), 2);
  EXPECT_EQ(rig.seen<UnexpectedLine>(), 0);
}

TEST(Shot2, MotionsTakeTurns) {
  Rig rig;
  const MotionId first = rig.move({{1, 5000}}), second = rig.move({{2, 300}}), third = rig.home();
  rig.run(milliseconds(100));
  EXPECT_EQ(rig.motion(second).state, MotionState::queued);
  EXPECT_EQ(rig.outcome(third), MotionState::succeeded);
  EXPECT_EQ(rig.motion(first).state, MotionState::succeeded);
  EXPECT_EQ(rig.motion(second).state, MotionState::succeeded);
  EXPECT_EQ(rig.unit.position(1), 0);
  EXPECT_TRUE(rig.controller.state().axis(2).homed);
}

TEST(Shot2, StopsDuringAMove) {
  Rig rig;
  const MotionId id = rig.move({{1, 100'000}});
  rig.run(milliseconds(500));
  std::optional<StopReport> report;
  rig.controller.stop(AxisSet::of(1), {.who = "bert"}, rig.now, [&](const StopReport& told) { report = told; });
  EXPECT_EQ(rig.outcome(id), MotionState::stopped);
  rig.run(milliseconds(500));
  ASSERT_TRUE(report);
  EXPECT_EQ(report->axes.at(0).wire_reply, "OK");
  EXPECT_LT(rig.unit.position(1), 100'000);
  EXPECT_FALSE(rig.unit.busy(1));
}

// The barrier of the family finds out that the unit had received the start, which is not sent again.
TEST(Shot2, AStartWhoseAnswerIsLostIsNotSentAgain) {
  Rig rig;
  rig.lose_answer_to = "G:";
  const MotionId id = rig.move({{1, 1000}});
  EXPECT_EQ(rig.outcome(id), MotionState::unknown);
  EXPECT_EQ(rig.written("G:1"), 1);
  EXPECT_EQ(rig.seen<BarrierEntered>(), 1);
  rig.run(std::chrono::seconds(2));
  EXPECT_EQ(rig.controller.state().link, LinkState::up);
  EXPECT_EQ(rig.controller.state().axis(1).position_pulses, 1000);
}

TEST(Shot2, AStartThatWasNotReceivedHasNotMovedAnything) {
  Rig rig;
  rig.lose_command = "G:";
  const MotionId id = rig.move({{1, 1000}});
  EXPECT_EQ(rig.outcome(id), MotionState::failed);
  EXPECT_EQ(rig.motion(id).problem->reason, Reason::not_sent);
  EXPECT_EQ(rig.unit.position(1), 0);
}

TEST(Shot2, AStopOutlivesTheLine) {
  Rig rig;
  const MotionId id = rig.move({{2, 100'000}});
  rig.run(milliseconds(500));
  rig.controller.link_down(rig.now, "unplugged");
  EXPECT_EQ(rig.motion(id).state, MotionState::unknown);
  bool stopped = false;
  rig.controller.stop(AxisSet::of(2), {.who = "bert"}, rig.now, [&](const StopReport&) { stopped = true; });
  rig.run(std::chrono::seconds(4));
  EXPECT_TRUE(stopped);
  EXPECT_FALSE(rig.unit.busy(2));
  EXPECT_LT(rig.unit.position(2), 100'000);
}

TEST(Shot2, RefusesWhatItCannot) {
  Rig rig;
  rig.move({{3, 5}});
  ASSERT_EQ(rig.answers.size(), 1u);
  EXPECT_EQ(rig.answers[0].error().reason, Reason::unknown_axis);
  EXPECT_THAT(rig.answers[0].error().message, HasSubstr("this unit has axes 1 and 2"));
  EXPECT_EQ(rig.controller.jog({}, rig.now, rig.answer()), 0u);
  EXPECT_EQ(rig.answers[1].error().reason, Reason::not_allowed);
}

TEST(Shot2, WindsDown) {
  Rig rig;
  const MotionId id = rig.move({{1, 100'000}});
  rig.run(milliseconds(300));
  bool over = false;
  rig.controller.wind_down(rig.now, [&](const WindDownReport&) { over = true; });
  rig.run(std::chrono::seconds(1));
  EXPECT_TRUE(over);
  EXPECT_EQ(rig.motion(id).state, MotionState::stopped);
  EXPECT_FALSE(rig.unit.busy(1));
}

}  // namespace
}  // namespace axisgate::shot2
