// Controllers in SHOT/FC mode with one, two and eight axes, over the line of the family.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shot/rig.h"

namespace axisgate::shot2 {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;

class Shot : public testing::TestWithParam<int> {
 protected:
  const int axes = GetParam();
  Rig rig{axes};
};
INSTANTIATE_TEST_SUITE_P(Stages, Shot, testing::Values(1, 2, 8));

TEST_P(Shot, ComesUpWithItsAxes) {
  EXPECT_EQ(rig.controller.state().link, LinkState::up);
  EXPECT_EQ(rig.controller.state().model, "SHOT-" + std::to_string(axes));
  EXPECT_EQ(rig.controller.state().controllable(), AxisSet::first(axes));
  EXPECT_THAT(std::vector<std::string>(rig.commands.begin(), rig.commands.begin() + 2),
              ElementsAre("*IDN?\r\n", "Q:SPC\r\n"));
}

TEST_P(Shot, MovesAllAxesAndTakesTheirNumbersForCompletions) {
  std::map<int, std::int64_t> targets;
  for (int axis = 1; axis <= axes; ++axis) targets[axis] = axis % 2 == 0 ? -20 * axis : 1000 * axis;
  const MotionId id = rig.move(targets);
  EXPECT_EQ(rig.outcome(id), MotionState::succeeded);
  for (const auto& [axis, target] : targets) EXPECT_EQ(rig.unit.position(axis), target) << axis;
  EXPECT_EQ(rig.seen<CompletionSeen>(), axes);
  EXPECT_EQ(rig.seen<UnexpectedLine>(), 0);
}

TEST_P(Shot, MotionsTakeTurns) {
  const MotionId first = rig.move({{1, 5000}}), second = rig.move({{axes, 300}}), third = rig.home();
  rig.run(milliseconds(100));
  EXPECT_EQ(rig.motion(second).state, MotionState::queued);
  EXPECT_EQ(rig.outcome(third), MotionState::succeeded);
  EXPECT_EQ(rig.motion(first).state, MotionState::succeeded);
  EXPECT_EQ(rig.motion(second).state, MotionState::succeeded);
  EXPECT_EQ(rig.unit.position(axes), 0);
  EXPECT_TRUE(rig.controller.state().axis(axes).homed);
}

TEST_P(Shot, StopsDuringAMove) {
  const MotionId id = rig.move({{axes, 100'000}});
  rig.run(milliseconds(500));
  std::optional<StopReport> report;
  rig.controller.stop(AxisSet::of(axes), {.who = "bert"}, rig.now, [&](const StopReport& told) { report = told; });
  EXPECT_EQ(rig.outcome(id), MotionState::stopped);
  rig.run(milliseconds(500));
  ASSERT_TRUE(report);
  EXPECT_EQ(report->axes.at(0).wire_reply, "OK");
  EXPECT_LT(rig.unit.position(axes), 100'000);
  EXPECT_FALSE(rig.unit.busy(axes));
}

TEST(Shot2, NamesBothAxesByOneLetter) {
  Rig rig(2);
  EXPECT_EQ(rig.outcome(rig.move({{1, 1000}, {2, -20}})), MotionState::succeeded);
  EXPECT_EQ(rig.written("AP:A+P1000-P20"), 1);
  EXPECT_EQ(rig.written("G:A"), 1);
}

TEST(Shot8, StopsWhatHasStartedIfAStartIsLost) {
  Rig rig(8);
  rig.lose_command = "G:3";
  const MotionId id = rig.move({{2, 50'000}, {3, 50'000}, {4, 50'000}});
  EXPECT_EQ(rig.outcome(id), MotionState::failed);
  rig.run(std::chrono::seconds(2));
  EXPECT_EQ(rig.written("G:4"), 0);
  EXPECT_FALSE(rig.unit.busy(2));
  EXPECT_LT(rig.unit.position(2), 50'000);
  EXPECT_EQ(rig.unit.position(3), 0);
}

// The barrier of the family finds out that the unit had received the start, which is not sent again.
TEST(Shot2, AStartWhoseAnswerIsLostIsNotSentAgain) {
  Rig rig(2);
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
  Rig rig(2);
  rig.lose_command = "G:";
  const MotionId id = rig.move({{1, 1000}});
  EXPECT_EQ(rig.outcome(id), MotionState::failed);
  EXPECT_EQ(rig.motion(id).problem->reason, Reason::not_sent);
  EXPECT_EQ(rig.unit.position(1), 0);
}

TEST_P(Shot, AStopOutlivesTheLine) {
  const MotionId id = rig.move({{axes, 100'000}});
  rig.run(milliseconds(500));
  rig.controller.link_down(rig.now, "unplugged");
  EXPECT_EQ(rig.motion(id).state, MotionState::unknown);
  bool stopped = false;
  rig.controller.stop(AxisSet::of(axes), {.who = "bert"}, rig.now, [&](const StopReport&) { stopped = true; });
  rig.run(std::chrono::seconds(4));
  EXPECT_TRUE(stopped);
  EXPECT_FALSE(rig.unit.busy(axes));
  EXPECT_LT(rig.unit.position(axes), 100'000);
}

TEST(Shot2, HomesNoAxisThatItDoesNotHave) {
  Rig rig(2);
  rig.controller.home({AxisSet::of(3), {.who = "anna"}}, rig.now, rig.answer());
  ASSERT_EQ(rig.answers.size(), 1u);
  EXPECT_EQ(rig.answers[0].error().reason, Reason::unknown_axis);
  EXPECT_EQ(rig.written("HRT:3"), 0);
}

TEST(Shot2, RefusesWhatItCannot) {
  Rig rig(2);
  rig.move({{3, 5}});
  ASSERT_EQ(rig.answers.size(), 1u);
  EXPECT_EQ(rig.answers[0].error().reason, Reason::unknown_axis);
  EXPECT_THAT(rig.answers[0].error().message, HasSubstr("this unit has axes 1 and 2"));
  EXPECT_EQ(rig.controller.jog({}, rig.now, rig.answer()), 0u);
  EXPECT_EQ(rig.answers[1].error().reason, Reason::not_allowed);
}

TEST_P(Shot, WindsDown) {
  const MotionId id = rig.move({{axes, 100'000}});
  rig.run(milliseconds(300));
  bool over = false;
  rig.controller.wind_down(rig.now, [&](const WindDownReport&) { over = true; });
  rig.run(std::chrono::seconds(1));
  EXPECT_TRUE(over);
  EXPECT_EQ(rig.motion(id).state, MotionState::stopped);
  EXPECT_FALSE(rig.unit.busy(axes));
}

}  // namespace
}  // namespace axisgate::shot2
