// Tests of targets that are approached from one side.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::milliseconds;
using testing::ElementsAre;

class Approaches : public testing::TestWithParam<std::int64_t> {};

// The axis begins below the target, above it, so near that it must first move back, and where the approach starts.
TEST_P(Approaches, ComeFromTheSameSide) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up());
  if (GetParam() != 0) moved(world, {{1, GetParam()}});
  const std::size_t before = world.outcomes().size(), lines = world.wire().commands().size();
  auto request = move_of(world, {{1, 5000}}, false);
  request.moves[0].approach = pulses(800);
  world.controller().move(request, world.now(), [](const Result<Motion>&) {});
  std::int64_t last = world.device().position(1);
  int steps_down_behind_the_turn = 0;
  bool turned = false;
  while (world.outcomes().size() == before && world.now() < TimePoint(std::chrono::minutes(5))) {
    world.run_for(milliseconds(1));
    const std::int64_t at = world.device().position(1);
    if (turned && at < last) ++steps_down_behind_the_turn;
    turned = turned || at == 4200;
    last = at;
  }
  EXPECT_EQ(world.device().position(1), 5000) << world.replay();
  EXPECT_EQ(steps_down_behind_the_turn, 0) << world.replay();
  EXPECT_EQ(world.outcomes().back().state, MotionState::succeeded);
  EXPECT_EQ(world.outcomes().back().kind, MotionKind::move);
  const auto sent = prebuffer_lines(world, lines);
  EXPECT_EQ(sent.size(), GetParam() == 4200 ? 1U : 2U) << world.replay();
  EXPECT_EQ(sent.front(), GetParam() == 4200 ? "AP:1+P5000" : "AP:1+P4200") << world.replay();
  EXPECT_EQ(sent.back(), "AP:1+P5000") << world.replay();
  EXPECT_TRUE(world.progress().empty()) << "a move has no segments to tell of";
}

INSTANTIATE_TEST_SUITE_P(From, Approaches, testing::Values(0, 9000, 4300, 4200, 5000));

TEST(Approach, SeveralAxesRestBetween) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up());
  auto request = move_of(world, {{1, 5000}, {2, -700}}, true);
  request.moves[0].approach = pulses(800);
  request.moves[1].approach = pulses(-100);
  world.controller().move(request, world.now(), [](const Result<Motion>&) {});
  EXPECT_EQ(outcome_of(world, 1).state, MotionState::succeeded) << world.replay();
  EXPECT_THAT(prebuffer_lines(world), ElementsAre("AP:A+P4200-P600", "AP:A+P5000-P700"));
  EXPECT_EQ(world.device().position(2), -700);
}

TEST(Approach, KeepsWithinTheTravel) {
  auto setup = quiet();
  setup.profile.axes[0].travel_minimum = pulses(-100);
  World world(setup);
  ASSERT_TRUE(world.run_until_up());
  auto request = move_of(world, {{1, 500}}, false);
  request.moves[0].approach = pulses(601);
  const auto checked = world.controller().check(request);
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().reason, Reason::outside_travel);
  request.moves[0].approach = pulses(600);
  EXPECT_TRUE(world.controller().check(request));
  request.moves[0].approach = pulses(0);
  EXPECT_EQ(world.controller().check(request).error().reason, Reason::invalid_request);
}

}  // namespace
}  // namespace axisgate::simulation
