// Tests of scans: constant speed over the range, the expected pulses, and a trigger that is restored.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::milliseconds;
using std::chrono::seconds;

ScanRequest scan_of(const World& world, std::int64_t from, std::int64_t to, std::int64_t interval) {
  ScanRequest request;
  request.axis = 1;
  request.from = pulses(from);
  request.to = pulses(to);
  request.speed = pulses(20'000);
  request.acceleration_ms = 100;
  request.interval = interval;
  request.context = world.context("tester");
  return request;
}

void start(World& world, const ScanRequest& request) {
  world.controller().scan(request, world.now(), [](const Result<Motion>&) {});
}

// S1000 F20000 R100: the ramp is (1000 + 20000) / 2 * 0.1 = 1050 pulses, so 3 intervals of 400 lie before the range.
TEST(Scan, GivesThePulsesThatAreDue) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up());
  start(world, scan_of(world, 10'000, 30'000, 400));
  const Motion motion = outcome_of(world, 1);
  EXPECT_EQ(motion.state, MotionState::succeeded) << world.replay();
  EXPECT_EQ(motion.kind, MotionKind::scan);
  ASSERT_TRUE(motion.scan);
  EXPECT_EQ(motion.scan->run_from, 8'800);
  EXPECT_EQ(motion.scan->run_to, 31'050);
  EXPECT_EQ(motion.scan->expected, 22'250 / 400);
  EXPECT_EQ(motion.scan->expected_in_range, 51);
  EXPECT_EQ(motion.scan->observed, motion.scan->expected);
  EXPECT_EQ(world.device().trigger_pulses(), 22'250 / 400) << world.replay();
  world.run_for(seconds(1));
  EXPECT_EQ(world.device().trigger(), "NS") << world.replay();
  EXPECT_EQ(written(world, "T:P1P400"), 1);
  EXPECT_EQ(written(world, "AP:1+P31050,S1000F20000R100"), 1) << world.replay();
  EXPECT_EQ(world.controller().state().axis(1).maximum_speed, 50'000) << "the speeds are the old ones again";
}

TEST(Scan, Backwards) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up());
  start(world, scan_of(world, 5'000, 1'000, 1000));
  const Motion motion = outcome_of(world, 1);
  EXPECT_EQ(motion.state, MotionState::succeeded) << world.replay();
  EXPECT_EQ(motion.scan->run_from, 7'000);
  EXPECT_EQ(motion.scan->run_to, -50);
  EXPECT_EQ(world.device().trigger_pulses(), motion.scan->expected);
}

// The speed is F from the first to the last pulse of the range.
TEST(Scan, RunsAtOneSpeedThroughTheRange) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up());
  start(world, scan_of(world, 2'000, 22'000, 100));
  ASSERT_TRUE(world.run_until([&] { return world.device().trigger() != "NS"; }, seconds(20)));
  // Read every millisecond: readings on the line are up to a poll apart.
  const auto reaches = [&](std::int64_t place) {
    for (int ms = 0; ms < 20'000 && world.device().position(1) < place; ++ms) world.run_for(milliseconds(1));
    return world.now();
  };
  const TimePoint in = reaches(2'000), out = reaches(22'000);
  EXPECT_GE(world.device().position(1), 22'000) << world.replay();
  const auto lasted = std::chrono::duration_cast<milliseconds>(out - in);
  EXPECT_NEAR(static_cast<double>(lasted.count()), 1000, 2) << "20000 pulses at 20000 pulses/s";
}

TEST(Scan, ByTheScale) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up());
  auto request = scan_of(world, 0, 4'000, 50);
  request.by_scale = true;
  start(world, request);
  const Motion motion = outcome_of(world, 1);
  EXPECT_EQ(motion.state, MotionState::succeeded) << world.replay();
  EXPECT_EQ(written(world, "T:E1P+50"), 1) << world.replay();
  ASSERT_TRUE(motion.scan->expected) << world.replay();
  EXPECT_EQ(world.device().trigger_pulses(), motion.scan->expected);
  EXPECT_EQ(motion.scan->observed, motion.scan->expected);
}

TEST(Scan, WhatCannotBe) {
  auto setup = quiet();
  setup.profile.axes[0].travel_maximum = pulses(30'000);
  World world(setup);
  ASSERT_TRUE(world.run_until_up());
  const auto refusal = [&](const ScanRequest& request) {
    const auto checked = world.controller().check(request);
    return checked ? Reason::unspecified : checked.error().reason;
  };
  auto request = scan_of(world, 1'000, 20'000, 400);
  EXPECT_EQ(refusal(request), Reason::unspecified);
  request.speed = pulses(56'001);
  EXPECT_EQ(refusal(request), Reason::too_fast);
  request.speed = pulses(56'000);
  EXPECT_EQ(refusal(request), Reason::unspecified);
  EXPECT_EQ(refusal(scan_of(world, 1'000, 1'000, 400)), Reason::invalid_request);
  EXPECT_EQ(refusal(scan_of(world, 1'000, 2'000, 1)), Reason::out_of_range);
  EXPECT_EQ(refusal(scan_of(world, 1'000, 2'000, 30'001)), Reason::out_of_range);
  EXPECT_EQ(refusal(scan_of(world, 1'000, 29'000, 400)), Reason::outside_travel) << "it slows down behind the range";
  EXPECT_THAT(world.controller().check(scan_of(world, 1'000, 29'000, 400)).error().message,
              testing::StartsWith("axis 1 would go to 300.5um"));
  EXPECT_EQ(motion_lines(world, 0) + written(world, "T:"), 0) << world.replay();
}

TEST(Scan, AStopDisarms) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up());
  start(world, scan_of(world, 10'000, 90'000, 400));
  ASSERT_TRUE(world.run_until([&] { return world.device().position(1) > 20'000; }, seconds(20)));
  EXPECT_FALSE(stopped(world).problem);
  const Motion motion = outcome_of(world, 1);
  EXPECT_EQ(motion.state, MotionState::stopped) << world.replay();
  world.run_for(seconds(2));
  EXPECT_EQ(world.device().trigger(), "NS") << world.replay();
  ASSERT_TRUE(motion.scan && motion.scan->observed);
  EXPECT_EQ(*motion.scan->observed, world.device().trigger_pulses());
  EXPECT_LT(*motion.scan->observed, *motion.scan->expected);
}

TEST(Scan, WhatWasArmedBeforeIsArmedAgain) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up());
  EXPECT_THAT(execute(world, {"T:T100"}), testing::ElementsAre("OK"));
  const std::string before = world.device().trigger();
  start(world, scan_of(world, 10'000, 20'000, 400));
  EXPECT_EQ(outcome_of(world, 2).state, MotionState::succeeded) << world.replay();
  world.run_for(seconds(1));
  EXPECT_EQ(world.device().trigger(), before) << world.replay();
}

// The line is lost during the scan: no other caller may move with its trigger armed.
TEST(Scan, ALostLineDisarmsLater) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up());
  start(world, scan_of(world, 10'000, 90'000, 400));
  ASSERT_TRUE(world.run_until([&] { return world.device().position(1) > 20'000; }, seconds(20)));
  world.wire().cut(world.now(), seconds(1));
  EXPECT_EQ(outcome_of(world, 1).state, MotionState::unknown) << world.replay();
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  moved(world, {{2, 100}});
  EXPECT_EQ(world.device().trigger(), "NS") << world.replay();
}

// The line is lost during a first scan, and another scan follows: the trigger from before both is restored.
TEST(Scan, OnesThatFollowALostOneLeaveNoTrigger) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up());
  start(world, scan_of(world, 10'000, 90'000, 500));
  ASSERT_TRUE(world.run_until([&] { return world.device().position(1) > 20'000; }, seconds(20)));
  world.wire().cut(world.now(), seconds(1));
  EXPECT_EQ(outcome_of(world, 1).state, MotionState::unknown) << world.replay();
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  // The first two attempts to restore the trigger are lost.
  world.wire().set_script([&world, lost = 0](LineKind kind, const std::string&) mutable -> Scripted {
    const bool hit = kind == LineKind::reply && world.wire().commands().back() == "T:S" && ++lost <= 2;
    return {.drop = hit, .delay = {}, .instead = {}};
  });
  start(world, scan_of(world, 10'000, 20'000, 400));
  EXPECT_EQ(outcome_of(world, 2, seconds(60)).state, MotionState::succeeded) << world.replay();
  world.run_for(seconds(2));
  EXPECT_EQ(world.device().trigger(), "NS") << world.replay();
}

// The line changes the answer to T: into NG, although the controller accepted the command.
TEST(Scan, AFalseRefusalOfTheTriggerLeavesNone) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up());
  world.wire().set_script([&world, done = false](LineKind kind, const std::string&) mutable -> Scripted {
    const bool hit = kind == LineKind::reply && !done && world.wire().commands().back().starts_with("T:P");
    done = done || hit;
    return {.drop = false, .delay = {}, .instead = hit ? std::optional<std::string>("NG\r\n") : std::nullopt};
  });
  start(world, scan_of(world, 10'000, 20'000, 400));
  EXPECT_EQ(outcome_of(world, 1).state, MotionState::failed) << world.replay();
  world.run_for(seconds(2));
  EXPECT_EQ(world.device().trigger(), "NS") << world.replay();
}

}  // namespace
}  // namespace axisgate::simulation
