// Tests of paths of lines and curves with rests between them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "server/access/leases.h"
#include "tests/simulation/random.h"
#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::HasSubstr;

Segment line(std::int64_t first, std::int64_t second) {
  Segment segment;
  segment.moves = {{1, pulses(first), {}}, {2, pulses(second), {}}};
  return segment;
}

Segment along(int axis, std::int64_t way) {
  Segment segment;
  segment.moves = {{axis, pulses(way), {}}};
  return segment;
}

Segment around(std::int64_t first, std::int64_t second, Rotation rotation, std::variant<int, Decimal> extent) {
  Segment segment;
  segment.curve = Curve{{1, 2}, Curve::Around{{pulses(first), pulses(second)}, rotation, extent}, {}};
  return segment;
}

Segment through(std::array<std::int64_t, 2> point, std::array<std::int64_t, 2> end) {
  Segment segment;
  segment.curve =
      Curve{{1, 2}, Curve::Through{{pulses(point[0]), pulses(point[1])}, {pulses(end[0]), pulses(end[1])}}, {}};
  return segment;
}

PathRequest path_of(const World& world, std::vector<Segment> segments) {
  return {std::move(segments), world.context("tester")};
}

Reason refusal_of(World& world, std::vector<Segment> segments) {
  Reason reason = Reason::unspecified;
  world.controller().run_path(path_of(world, std::move(segments)), world.now(), [&](const Result<Motion>& motion) {
    if (!motion) reason = motion.error().reason;
  });
  return reason;
}

void run(World& world, std::vector<Segment> segments) {
  world.controller().run_path(path_of(world, std::move(segments)), world.now(), [](const Result<Motion>&) {});
}

TEST(PathShapes, LinesAndCurvesInOneChain) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up());
  auto first = line(2000, 1000);
  first.speed = pulses(5000);
  run(world, {first, around(0, 1000, Rotation::counterclockwise, Decimal{90, 0}), line(0, -500),
              through({1000, 1000}, {2000, 0}), around(-300, 400, Rotation::clockwise, 1), line(-100, -100)});
  const Motion motion = outcome_of(world, 1);
  EXPECT_EQ(motion.state, MotionState::succeeded) << world.replay();
  EXPECT_THAT(prebuffer_lines(world),
              ElementsAre("KP:A+P2000+P1000,S5000F50000R100", "EP:1A1+P0+P1000D90", "KP:A+P0-P500",
                          "EP:2A0+P1000+P1000+P2000+P0", "EP:0A0-P300+P400", "KP:A-P100-P100"));
  EXPECT_EQ(world.device().position(1), 2000 + 1000 + 0 + 2000 + 0 - 100);
  EXPECT_EQ(world.device().position(2), 1000 + 1000 - 500 + 0 + 0 - 100);
  EXPECT_EQ(motion.underruns, 0);
  EXPECT_EQ(motion.segments_done, 6);
  std::vector<std::string> replies;
  for (const auto& news : world.progress()) {
    if (news.step == PathProgress::Step::sent) replies.push_back(news.wire_reply);
  }
  EXPECT_THAT(replies, ElementsAre("OK", "OK_D", "OK_D", "OK_D", "OK_D", "OK_D"));
}

TEST(PathShapes, AHelixBetweenStraightLines) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up());
  Segment straight;
  straight.moves = {{1, pulses(100), {}}, {2, pulses(200), {}}, {3, pulses(300), {}}};
  Segment helix = around(500, 0, Rotation::counterclockwise, 3);
  helix.curve->rise = pulses(-40);
  Segment half = around(500, 0, Rotation::clockwise, Decimal{180, 0});
  half.curve->rise = pulses(70);
  run(world, {straight, helix, half, straight});
  EXPECT_EQ(outcome_of(world, 1, seconds(60)).state, MotionState::succeeded) << world.replay();
  EXPECT_THAT(prebuffer_lines(world), ElementsAre("KP:D+P100+P200+P300", "EP:3A1N3+P500+P0-P40",
                                                  "EP:4A0+P500+P0D180+P70", "KP:D+P100+P200+P300"));
  EXPECT_EQ(world.device().position(1), 1200);
  EXPECT_EQ(world.device().position(2), 400);
  EXPECT_EQ(world.device().position(3), 300 - 120 + 70 + 300);
}

TEST(PathShapes, PlacesInsteadOfWays) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up());
  moved(world, {{1, 300}, {2, -200}});
  auto to = line(1000, 1000), back = line(40, -30),
       turn = around(500, 500, Rotation::counterclockwise, Decimal{180, 0});
  to.relative = back.relative = turn.relative = false;
  const std::size_t before = world.wire().commands().size();
  run(world, {to, turn, back, line(5, 5)});
  EXPECT_EQ(outcome_of(world, 2).state, MotionState::succeeded) << world.replay();
  // 180 degrees about (500, 500) lead from (1000, 1000) to (0, 0).
  EXPECT_THAT(prebuffer_lines(world, before),
              ElementsAre("KP:A+P700+P1200", "EP:1A1-P500-P500D180", "KP:A+P40-P30", "KP:A+P5+P5"));
  EXPECT_EQ(world.device().position(1), 45);
  EXPECT_EQ(world.device().position(2), -25);
}

TEST(PathShapes, WhatCannotBe) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up());
  EXPECT_EQ(refusal_of(world, {through({100, 100}, {200, 200})}), Reason::invalid_request) << "on one line";
  EXPECT_EQ(refusal_of(world, {around(0, 0, Rotation::clockwise, 1)}), Reason::invalid_request) << "no radius";
  EXPECT_EQ(refusal_of(world, {around(5, 0, Rotation::clockwise, 2)}), Reason::out_of_range) << "two turns";
  EXPECT_EQ(refusal_of(world, {around(5, 0, Rotation::clockwise, Decimal{361, 0})}), Reason::out_of_range);
  EXPECT_EQ(refusal_of(world, {line(1, 1), along(1, 5)}), Reason::invalid_request) << "other axes";
  Segment helix = around(5, 0, Rotation::clockwise, 1);
  helix.curve->axes = {1, 3};
  helix.curve->rise = pulses(5);
  EXPECT_EQ(refusal_of(world, {helix}), Reason::invalid_request) << "a helix turns in axes 1 and 2";
  auto resting = line(1, 1);
  resting.rest = milliseconds(255'001);
  EXPECT_EQ(refusal_of(world, {resting}), Reason::out_of_range);
  EXPECT_EQ(motion_lines(world, 0), 0) << world.replay();
}

TEST(PathShapes, TheWholeCurveKeepsWithinTheTravel) {
  auto setup = quiet();
  setup.profile.axes[1].travel_maximum = pulses(1999);
  World world(setup);
  ASSERT_TRUE(world.run_until_up());
  // The circle ends where it began, and reaches 2000 in between.
  EXPECT_EQ(refusal_of(world, {around(0, 1000, Rotation::counterclockwise, 1)}), Reason::outside_travel);
  EXPECT_EQ(motion_lines(world, 0), 0) << world.replay();
  run(world, {around(0, 999, Rotation::counterclockwise, 1)});
  EXPECT_EQ(outcome_of(world, 1).state, MotionState::succeeded) << world.replay();
}

// Every seed draws one interpretation of each of the manual's open questions.
class PathShapesSeeds : public testing::TestWithParam<int> {};

TEST_P(PathShapesSeeds, EndWhereTheirSumIs) {
  auto setup = drawn_setup(static_cast<std::uint64_t>(GetParam()), Faults{});
  World world(setup);
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  Random random(static_cast<std::uint64_t>(GetParam()));
  for (std::size_t round = 1; round <= 4; ++round) {
    std::vector<Segment> segments;
    std::int64_t first = world.device().position(1), second = world.device().position(2);
    for (int i = 0; i < 6; ++i) {
      const std::int64_t a = random.between(200, 900), b = random.between(-900, -200);
      switch (random.between(0, 3)) {
        case 0:
          segments.push_back(line(a, b));
          first += a;
          second += b;
          break;
        case 1:
          segments.push_back(through({a, 0}, {a, b}));
          first += a;
          second += b;
          break;
        case 2: {  // half a turn leads to the other side of the centre
          segments.push_back(around(a, b, Rotation::clockwise, Decimal{180, 0}));
          first += 2 * a;
          second += 2 * b;
          break;
        }
        default:  // a quarter turn, counterclockwise: the centre as seen from the end is (-b, a)
          segments.push_back(around(a, b, Rotation::counterclockwise, Decimal{90, 0}));
          first += a + b;
          second += b - a;
      }
      if (random.between(0, 4) == 0) segments.back().rest = milliseconds(random.between(1, 200));
    }
    const std::size_t before = world.outcomes().size();
    run(world, segments);
    EXPECT_EQ(outcome_of(world, before + 1, seconds(120)).state, MotionState::succeeded) << world.replay();
    EXPECT_EQ(world.device().position(1), first) << world.replay();
    EXPECT_EQ(world.device().position(2), second) << world.replay();
  }
}

INSTANTIATE_TEST_SUITE_P(Drawn, PathShapesSeeds, testing::Range(1, 41));

TEST(PathRests, TheAxesStandMeanwhile) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up());
  auto later = line(300, 0);
  later.rest = milliseconds(700);
  run(world, {line(1000, 0), later, line(-300, 0)});
  ASSERT_TRUE(world.run_until([&] { return world.device().position(1) == 1000; }, seconds(10)));
  const TimePoint there = world.now();
  ASSERT_TRUE(world.run_until([&] { return world.device().position(1) != 1000; }, seconds(10)));
  EXPECT_GE(world.now() - there, milliseconds(700)) << world.replay();
  EXPECT_LE(world.now() - there, milliseconds(1200)) << world.replay();
  const Motion motion = outcome_of(world, 1);
  EXPECT_EQ(motion.state, MotionState::succeeded) << world.replay();
  EXPECT_EQ(motion.underruns, 0) << "a rest is no underrun";
  EXPECT_EQ(motion.segments_done, 3);
}

// The axis is where the path would end, but a path that did not continue is not a success.
TEST(PathRests, AStopWhileItRests) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up());
  auto there = along(1, 500), back = along(1, -500);
  there.rest = back.rest = seconds(2);
  run(world, {along(1, 1000), there, back});
  ASSERT_TRUE(world.run_until([&] { return world.device().position(1) == 1000; }, seconds(10)));
  world.run_for(milliseconds(500));
  const std::size_t lines = world.wire().commands().size();
  EXPECT_FALSE(stopped(world).problem) << world.replay();
  EXPECT_EQ(outcome_of(world, 1).state, MotionState::stopped) << world.replay();
  world.run_for(seconds(5));
  EXPECT_EQ(motion_lines(world, lines), 0) << world.replay();
  EXPECT_EQ(world.device().position(1), 1000);
  moved(world, {{1, 100}});
}

TEST(PathRests, InputsNeedTheConfiguration) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up());
  auto second = along(1, 100);
  second.inputs = 5;
  EXPECT_EQ(refusal_of(world, {along(1, 100), second}), Reason::not_allowed);
  EXPECT_EQ(motion_lines(world, 0), 0) << world.replay();
}

Setup with_inputs() {
  auto setup = quiet();
  setup.profile.wait_for_inputs = true;
  return setup;
}

TEST(PathRests, InputsAreWaitedFor) {
  World world(with_inputs());
  ASSERT_TRUE(world.run_until_up());
  auto second = along(1, 100);
  second.inputs = 5;
  run(world, {along(1, 1000), second});
  ASSERT_TRUE(world.run_until([&] { return world.controller().state().axis(1).armed; }, seconds(10)));
  world.device().set_inputs(4);
  world.run_for(seconds(3));
  EXPECT_EQ(world.device().position(1), 1000) << world.replay();
  world.device().set_inputs(5);
  EXPECT_EQ(outcome_of(world, 1).state, MotionState::succeeded) << world.replay();
  EXPECT_EQ(world.device().position(1), 1100);
  EXPECT_FALSE(world.controller().state().axis(1).armed);
}

TEST(PathRests, OneMisreadInputStartsNothing) {
  World world(with_inputs());
  ASSERT_TRUE(world.run_until_up());
  world.wire().set_script([&world, hits = 0](LineKind kind, const std::string&) mutable -> Scripted {
    const bool hit = kind == LineKind::reply && world.wire().commands().back() == "I:" && ++hits == 5;
    return {.drop = false, .delay = {}, .instead = hit ? std::optional<std::string>("5\r\n") : std::nullopt};
  });
  auto second = along(1, 100);
  second.inputs = 5;
  run(world, {along(1, 1000), second});
  ASSERT_TRUE(world.run_until([&] { return written(world, "I:") > 12; }, seconds(30))) << world.replay();
  EXPECT_EQ(world.device().position(1), 1000) << world.replay();
  EXPECT_FALSE(stopped(world).problem);
}

// A person at the front panel moves an axis while the path rests.
TEST(PathRests, WhatWasMovedMeanwhileIsNoticed) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up());
  auto later = along(1, 300);
  later.rest = seconds(4);
  run(world, {along(1, 1000), later});
  ASSERT_TRUE(world.run_until([&] { return world.device().position(1) == 1000; }, seconds(10)));
  world.run_for(milliseconds(500));
  const std::size_t lines = world.wire().commands().size();
  // The sender of this motion does not matter: its line is not the gateway's.
  world.wire().cut(world.now(), milliseconds(0));
  world.device().receive("M:1+P70\r\n", world.now());
  world.device().receive("G:1\r\n", world.now());
  const Motion motion = outcome_of(world, 1);
  EXPECT_NE(motion.state, MotionState::succeeded) << world.replay();
  EXPECT_EQ(written(world, "MP:", lines), 0) << world.replay();
}

// The lease of a path that waits for inputs ends, with the policy to finish motions: the inputs then start nothing.
TEST(PathRests, InputsStartNothingOnceTheLeaseHasEnded) {
  server::LeaseTokens tokens{1};
  server::Leases leases{tokens};
  auto setup = with_inputs();
  setup.permission = &leases;
  World world(setup);
  ASSERT_TRUE(world.run_until_up());
  std::uint64_t token = 0;
  leases.acquire({.scope = AxisSet::of(1), .at_loss = server::AtLoss::finish}, "anna", false, world.now(), world.now(),
                 [&](const Result<server::Lease>& got) {
                   ASSERT_TRUE(got);
                   token = got->token;
                 });
  auto second = along(1, 100);
  second.inputs = 5;
  PathRequest request = path_of(world, {along(1, 1000), second});
  request.context.who = "anna";
  request.context.lease = token;
  world.controller().run_path(request, world.now(), [](const Result<Motion>&) {});
  ASSERT_TRUE(world.run_until([&] { return world.controller().state().axis(1).armed; }, seconds(10)));
  EXPECT_TRUE(leases.release(token, world.now()));
  world.run_for(seconds(1));
  world.device().set_inputs(5);
  EXPECT_EQ(outcome_of(world, 1).state, MotionState::stopped) << world.replay();
  EXPECT_EQ(world.device().position(1), 1000) << world.replay();
}

// The circle ends a pulse beside its beginning, and may end another pulse further: an axis that stays at the beginning
// is no success.
TEST(PathShapes, ANearlyWholeCircleIsSeenToRun) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up());
  run(world, {line(0, 500), around(5000, 0, Rotation::counterclockwise, Decimal{35'999, 2})});
  EXPECT_EQ(outcome_of(world, 1, seconds(120)).state, MotionState::succeeded) << world.replay();
  EXPECT_FALSE(world.device().busy(1)) << world.replay();
}

}  // namespace
}  // namespace axisgate::simulation
