// Tests of the travel envelope along curves and to saved positions: sent curves stay within it over the stage's whole
// real path, and nothing else is refused.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "tests/simulation/random.h"
#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::milliseconds;
using std::chrono::seconds;

struct Reached {
  std::array<std::int64_t, kAxisCount> lowest{}, highest{};
};

// Sends the lines, and watches the stage's position until it is stationary.
Reached run_and_watch(World& world, const std::vector<std::string>& lines, std::string& problem) {
  bool ended = false;
  world.controller().execute({lines, world.context("anna")}, world.now(), [&](const ExecuteEvent& event) {
    if (event.kind != ExecuteEvent::Kind::ended) return;
    ended = true;
    if (event.problem) problem = name(event.problem->reason);
  });
  Reached reached;
  const auto moves = [&] { return world.device().busy(1) || world.device().busy(2) || world.device().busy(3); };
  for (int step = 0; step < 60'000 && (!ended || moves()); ++step) {
    world.run_for(milliseconds(2));
    for (int axis = 1; axis <= kAxisCount; ++axis) {
      const auto place = static_cast<std::size_t>(axis - 1);
      const std::int64_t at = world.device().position(axis);
      reached.lowest[place] = std::min(reached.lowest[place], at);
      reached.highest[place] = std::max(reached.highest[place], at);
    }
  }
  return reached;
}

std::string coordinate(Random& random) { return fmt::format("{:+d}", random.between(-900, 900)).insert(1, "P"); }

struct DrawnCurve {
  std::string line;
  bool other_direction = false;  // for a passing point: the gateway checks both directions against the envelope
};

DrawnCurve drawn_curve(Random& random) {
  const auto kind = random.between(0, 5);
  const char plane = kind < 3 ? "ABC"[random.between(0, 2)] : 'A';
  std::string line = fmt::format("E:{}{}{}", kind, plane, random.between(0, 1));
  if (kind == 3) line += fmt::format("N{}", random.between(1, 3));
  line += coordinate(random) + coordinate(random);
  if (kind == 1) line += fmt::format("D{}", random.between(1, 360));
  if (kind == 4) line += fmt::format("D{}", random.between(1, 800));
  if (kind == 2 || kind == 5) line += coordinate(random) + coordinate(random);
  if (kind >= 3) line += coordinate(random);
  return {line, kind == 2 || kind == 5};
}

class CurvesAndTravel : public testing::TestWithParam<int> {};

TEST_P(CurvesAndTravel, WhatIsSentKeepsWithin) {
  Random random(static_cast<std::uint64_t>(GetParam()));
  for (int i = 0; i < 25; ++i) {
    const DrawnCurve curve = drawn_curve(random);
    World free(quiet());
    ASSERT_TRUE(free.run_until_up());
    const std::vector<std::string> lines = {"D:WS5000F50000R100 S5000F50000R100 S5000F50000R100", curve.line, "G:W"};
    std::string problem;
    const Reached really = run_and_watch(free, lines, problem);
    if (!problem.empty()) continue;  // three points on a line, or the circle is too wide
    auto setup = quiet();
    bool leaves = false, nearly = false;
    for (std::size_t axis = 0; axis < kAxisCount; ++axis) {
      const std::int64_t minimum = -random.between(100, 3000), maximum = random.between(100, 3000);
      setup.profile.axes[axis].travel_minimum = pulses(minimum);
      setup.profile.axes[axis].travel_maximum = pulses(maximum);
      leaves = leaves || really.lowest[axis] < minimum || really.highest[axis] > maximum;
      // The device's rounding is unknown, and its position is read every 2 ms.
      nearly = nearly || really.lowest[axis] - 12 < minimum || really.highest[axis] + 12 > maximum;
    }
    World bounded(setup);
    ASSERT_TRUE(bounded.run_until_up());
    const Reached kept = run_and_watch(bounded, lines, problem);
    const bool refused = problem == "OUTSIDE_TRAVEL";
    const std::string what = fmt::format("seed {} case {}: {}: {}", GetParam(), i, curve.line, problem);
    EXPECT_TRUE(refused || problem.empty()) << what;
    EXPECT_TRUE(refused || !leaves) << what;
    EXPECT_TRUE(!refused || nearly || curve.other_direction) << what;
    for (std::size_t axis = 0; axis < kAxisCount; ++axis) {
      EXPECT_GE(kept.lowest[axis], setup.profile.axes[axis].travel_minimum->value.digits) << what;
      EXPECT_LE(kept.highest[axis], setup.profile.axes[axis].travel_maximum->value.digits) << what;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, CurvesAndTravel, testing::Range(1, 9));

// Only the end lies within the envelope (manual 71): a whole circle ends where it began).
TEST(CurvesAndTravelByHand, ACircleIsMoreThanItsEnd) {
  auto setup = quiet();
  setup.profile.axes[1].travel_maximum = pulses(99);
  World world(setup);
  ASSERT_TRUE(world.run_until_up());
  EXPECT_EQ(execute(world, {"E:0A0+P100+P0", "G:A"}), std::vector<std::string>{"OUTSIDE_TRAVEL"}) << world.replay();
  EXPECT_EQ(written(world, "E:"), 0) << world.replay();
  EXPECT_EQ(execute(world, {"E:1A1+P100+P0D90", "G:A"}).front(), "OK") << world.replay();
}

// A chained curve starts without a command, and one setting may replace another (manual 2. 2), 85)).
TEST(CurvesAndTravelByHand, EachSettingKeepsWithinByItself) {
  auto setup = quiet();
  for (auto& axis : setup.profile.axes) {
    axis.travel_minimum = pulses(-1000);
    axis.travel_maximum = pulses(1000);
  }
  World world(setup);
  ASSERT_TRUE(world.run_until_up());
  const std::vector<std::string> outside{"OUTSIDE_TRAVEL"};
  EXPECT_EQ(execute(world, {"MP:A+P10+P10", "G:A", "EP:0A0+P500000+P0"}), outside) << world.replay();
  EXPECT_EQ(execute(world, {"E:0A0+P0+P500000", "G:1"}), outside) << world.replay();
  EXPECT_EQ(execute(world, {"M:1-P900", "E:0A0+P750+P0", "G:A"}), outside) << world.replay();
  EXPECT_EQ(execute(world, {"A:1-P900", "M:1+P100", "G:1", "MP:1+P1500", "G:1"}),
            std::vector<std::string>{"POSITION_UNKNOWN"})
      << world.replay();
  EXPECT_EQ(motion_lines(world, 0), 0) << world.replay();
}

// A curve runs at S, which may be set again between the curve and its start.
TEST(CurvesAndTravelByHand, TheSpeedCountsAtTheStart) {
  auto setup = quiet();
  setup.profile.axes[1].maximum_speed = pulses(1000);
  World world(setup);
  ASSERT_TRUE(world.run_until_up());
  EXPECT_EQ(execute(world, {"D:1S500F500R100", "E:0A0+P0+P10000", "D:1S100000F100000R100", "G:A"}),
            std::vector<std::string>{"TOO_FAST"})
      << world.replay();
}

// The circle ends where it began, so that READY at its target is no evidence.
TEST(CurvesAndTravelByHand, ACircleThatNeverRanIsUnknown) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up());
  world.wire().set_script(drop_first(world, LineKind::command, "G:A"));
  execute(world, {"E:0A0+P100+P0", "G:A"});
  world.run_for(seconds(10));
  ASSERT_FALSE(world.outcomes().empty()) << world.replay();
  EXPECT_EQ(world.outcomes().back().state, MotionState::unknown) << world.replay();
}

// A saved place stays where it was saved, even if its coordinates have changed since (manual 129)).
TEST(CurvesAndTravelByHand, ASavedPositionIsAskedForBeforeItIsGoneTo) {
  auto setup = quiet();
  setup.profile.axes[0].travel_maximum = pulses(5000);
  World world(setup);
  ASSERT_TRUE(world.run_until_up());
  execute(world, {"PSET:1+P6000"});
  execute(world, {"PIT:SET,1"});
  execute(world, {"PSET:1+P0"});
  EXPECT_EQ(execute(world, {"PIT:G,1"}), std::vector<std::string>{"OK"}) << world.replay();
  execute(world, {"PSET:1+P6000"});
  EXPECT_EQ(execute(world, {"PIT:GRT,1"}), std::vector<std::string>{"OUTSIDE_TRAVEL"}) << world.replay();
  EXPECT_EQ(execute(world, {"PAV:G,7"}), std::vector<std::string>{"NOT_FOUND"}) << world.replay();
  EXPECT_EQ(written(world, "PIT:GRT"), 0) << world.replay();
  EXPECT_EQ(written(world, "PAV:G,"), 0) << world.replay();
}

TEST(CurvesAndTravelByHand, ASavedPositionIsReachedWithItsNumbers) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up());
  execute(world, {"PAV:SET,2"});
  moved(world, {{1, 3000}, {2, 2000}, {3, 1000}});
  EXPECT_EQ(execute(world, {"PAV:GRT,2"}),
            (std::vector<std::string>{"OK", "completion 3", "completion 2", "completion 1"}))
      << world.replay();
  EXPECT_EQ(world.device().position(1), 0) << world.replay();
}

}  // namespace
}  // namespace axisgate::simulation
