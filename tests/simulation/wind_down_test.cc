// Tests of the gateway's end: every request is refused, withdrawn, stopped or finished, and the line is left clean.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "tests/simulation/callers.h"
#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

// The gateway's end in progress.
class Ending {
 public:
  explicit Ending(World& world) : world_(world), report_(std::make_shared<std::optional<WindDownReport>>()) {
    world.controller().wind_down(world.now(), [report = report_, &world](const WindDownReport& told) {
      *report = told;
      world.wire().note(world.now(), "   the end");
    });
  }

  bool over() const { return report_->has_value(); }
  WindDownReport wait(Duration limit = seconds(120)) {
    EXPECT_TRUE(world_.run_until([this] { return over(); }, limit)) << world_.replay();
    EXPECT_TRUE(world_.violations().empty()) << world_.replay();
    return report_->value_or(WindDownReport{});
  }

 private:
  World& world_;
  std::shared_ptr<std::optional<WindDownReport>> report_;
};

Setup with(AtExit policy) {
  Setup setup = quiet();
  setup.profile.at_exit = policy;
  return setup;
}

std::vector<MotionState> outcomes_of(const WindDownReport& report) {
  std::vector<MotionState> states;
  for (const Motion& motion : report.motions) states.push_back(motion.state);
  return states;
}

using testing::ElementsAre;
using testing::IsEmpty;

TEST(WindDown, AtRestTheExchangeOnTheWireIsFinishedAndNothingFollows) {
  bool met = false;
  for (Duration offset{}; offset < milliseconds(30) && !HasFailure(); offset += microseconds(310)) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    int ended = 0;
    for (const char* question : {"?:V", "?:N"}) {
      world.controller().execute({{question}, world.context("tester")}, world.now(),
                                 [&](const ExecuteEvent& event) { ended += event.kind == ExecuteEvent::Kind::ended; });
    }
    world.run_for(offset);
    const std::size_t sent = world.wire().commands().size();
    const std::uint64_t answered = world.exchanges();
    Ending ending(world);
    const bool on_the_wire = !ending.over();
    EXPECT_THAT(ending.wait(seconds(1)).motions, IsEmpty());
    EXPECT_EQ(world.exchanges(), answered + (on_the_wire ? 1 : 0)) << world.replay();
    EXPECT_EQ(ended, 2) << "each caller is told\n" << world.replay();
    world.run_for(seconds(5));
    EXPECT_EQ(world.wire().commands().size(), sent) << world.replay();
    met = met || on_the_wire;
  }
  EXPECT_TRUE(met);
}

TEST(WindDown, ARunningMoveIsStoppedAndSeenToStand) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  move_by(world, {{1, 500000}});
  world.run_for(milliseconds(400));
  ASSERT_TRUE(world.device().busy(1));
  Ending ending(world);
  const WindDownReport report = ending.wait(seconds(10));
  EXPECT_THAT(outcomes_of(report), ElementsAre(MotionState::stopped)) << world.replay();
  EXPECT_FALSE(report.problem) << report.problem->message;
  EXPECT_FALSE(world.device().busy(1));
  EXPECT_EQ(written(world, "L:1"), 1) << world.replay();
}

TEST(WindDown, FinishLetsTheRunningMoveComeToItsTarget) {
  World world(with(AtExit::finish));
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  move_by(world, {{1, 100000}});
  world.run_for(milliseconds(400));
  ASSERT_TRUE(world.device().busy(1));
  Ending ending(world);
  EXPECT_THAT(outcomes_of(ending.wait()), ElementsAre(MotionState::succeeded)) << world.replay();
  EXPECT_EQ(world.device().position(1), 100000);
  EXPECT_EQ(written(world, "L:"), 0) << world.replay();
}

TEST(WindDown, FinishLetsARunningPathComeToItsEnd) {
  World world(with(AtExit::finish));
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  PathRequest path;
  path.context = world.context("tester");
  for (int i = 0; i < 20; ++i)
    path.segments.push_back({.moves = {{1, pulses(5000), {}}}, .speed = {}, .acceleration_ms = {}});
  world.controller().run_path(path, world.now(), [](Result<Motion>) {});
  world.run_for(milliseconds(500));
  Ending ending(world);
  EXPECT_THAT(outcomes_of(ending.wait()), ElementsAre(MotionState::succeeded)) << world.replay();
  EXPECT_EQ(world.device().position(1), 100000);
}

TEST(WindDown, FinishHasALimitAndStopsThen) {
  World world(with(AtExit::finish));
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  ASSERT_EQ(execute(world, {"D:1S1F1R1"}), std::vector<std::string>{"OK"});
  move_by(world, {{1, 1000}});
  world.run_for(milliseconds(400));
  ASSERT_TRUE(world.device().busy(1));
  const TimePoint begun = world.now();
  Ending ending(world);
  EXPECT_THAT(outcomes_of(ending.wait()), ElementsAre(MotionState::stopped)) << world.replay();
  EXPECT_GE(world.now() - begun, Controller::kFinishLimit);
  EXPECT_LE(world.now() - begun, Controller::kFinishLimit + seconds(2));
  EXPECT_FALSE(world.device().busy(1));
}

// Under every policy, a motion that has not started never starts, at any instant of set and go.
TEST(WindDown, NothingStartsAfterItHasBegun) {
  for (const AtExit policy : {AtExit::stop, AtExit::finish}) {
    for (Duration offset{}; offset < milliseconds(80) && !HasFailure(); offset += microseconds(410)) {
      World world(with(policy));
      ASSERT_TRUE(world.run_until_up()) << world.replay();
      const std::size_t first = world.wire().commands().size();
      move_by(world, {{1, 30000}});
      move_by(world, {{2, 30000}});
      world.run_for(offset);
      const bool gone = written(world, "G:", first) > 0;
      const std::size_t before = world.wire().commands().size();
      Ending ending(world);
      const WindDownReport report = ending.wait();
      ASSERT_EQ(report.motions.size(), 2u) << world.replay();
      EXPECT_EQ(motion_lines(world, before), 0) << world.replay();
      EXPECT_EQ(world.device().starts(1), gone ? 1 : 0) << world.replay();
      EXPECT_EQ(world.device().starts(2), 0) << world.replay();
      const Motion& second = report.motions[report.motions[0].id == 2 ? 0 : 1];
      const Motion& one = report.motions[report.motions[0].id == 2 ? 1 : 0];
      ASSERT_TRUE(second.problem && second.state == MotionState::failed) << world.replay();
      EXPECT_EQ(second.problem->reason, Reason::not_sent);
      const MotionState expected = gone && policy == AtExit::finish ? MotionState::succeeded : MotionState::stopped;
      EXPECT_EQ(one.state, expected) << world.replay();
      world.run_for(seconds(5));
      EXPECT_FALSE(world.device().busy(1)) << world.replay();
    }
  }
}

TEST(WindDown, WhatComesAfterwardsIsRefusedButForAStop) {
  World world(with(AtExit::finish));
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  move_by(world, {{1, 500000}});
  world.run_for(milliseconds(400));
  Ending ending(world);
  std::vector<Reason> reasons;
  const auto refused = [&](const auto& result) {
    reasons.push_back(result ? Reason::internal : result.error().reason);
  };
  Controller& controller = world.controller();
  const HomeRequest all{{}, world.context("late")};
  controller.move(move_of(world, {{2, 100}}, true), world.now(), refused);
  controller.home(all, world.now(), refused);
  controller.return_to_origin(all, world.now(), refused);
  controller.run_path({{{.moves = {{2, pulses(5), {}}}, .speed = {}, .acceleration_ms = {}}}, world.context("late")},
                      world.now(), refused);
  controller.refresh(Duration::zero(), world.context("late"), world.now(), refused);
  controller.clear_errors({}, world.context("late"), world.now(), refused);
  EXPECT_EQ(reasons, std::vector<Reason>(6, Reason::not_sent));
  EXPECT_EQ(execute(world, {"?:V"}), std::vector<std::string>{"NOT_SENT"});
  EXPECT_FALSE(ending.over());
  EXPECT_FALSE(stopped(world).problem);
  EXPECT_THAT(outcomes_of(ending.wait(seconds(2))), ElementsAre(MotionState::stopped)) << world.replay();
}

TEST(WindDown, ADeadLineDoesNotHoldTheEndUp) {
  for (int silent = 0; silent < 4000 && !HasFailure(); silent += 130) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    move_by(world, {{1, 1'500'000}});
    ASSERT_TRUE(world.run_until([&] { return world.device().busy(1); }, seconds(10))) << world.replay();
    world.wire().set_script([&](LineKind kind, const std::string&) -> Scripted {
      return {.drop = kind != LineKind::command, .delay = {}, .instead = {}};
    });
    world.run_for(milliseconds(silent));
    const TimePoint begun = world.now();
    Ending ending(world);
    const WindDownReport report = ending.wait();
    EXPECT_LE(world.now() - begun, Controller::kStopLimit + seconds(6)) << world.replay();
    world.run_for(seconds(2));
    ASSERT_EQ(world.outcomes().size(), 1u) << world.replay();
    EXPECT_EQ(world.outcomes()[0].state, MotionState::unknown) << world.replay();
    EXPECT_TRUE(report.problem) << "nobody saw the axis stand\n" << world.replay();
    EXPECT_GE(written(world, "L:"), 1) << world.replay();
    EXPECT_FALSE(world.device().busy(1)) << world.replay();
  }
}

// The line is lost in mid-move and reopened for the stop. Closing it again discards bytes that have not been sent yet.
TEST(WindDown, AStopThatNobodyAnswersStillGoesOut) {
  auto setup = quiet();
  setup.baud = setup.profile.baud = 1200;
  World world(setup);
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  move_by(world, {{1, 1'500'000}});
  ASSERT_TRUE(world.run_until([&] { return world.device().busy(1); }, seconds(10))) << world.replay();
  world.wire().set_script([&](LineKind kind, const std::string&) -> Scripted {
    return {.drop = kind != LineKind::command, .delay = {}, .instead = {}};
  });
  EXPECT_EQ(outcome_of(world, 1).state, MotionState::unknown);
  Ending ending(world);
  EXPECT_TRUE(ending.wait(seconds(2)).problem) << world.replay();
  world.wire().cut(world.now(), seconds(100));
  world.run_for(seconds(2));
  EXPECT_EQ(written(world, "L:"), 1) << world.replay();
  EXPECT_FALSE(world.device().busy(1)) << world.replay();
}

TEST(WindDown, WithoutALineItIsOverAtOnce) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.wire().cut(world.now(), seconds(100));
  world.run_for(seconds(1));
  Ending ending(world);
  EXPECT_TRUE(ending.over());
}

TEST(WindDown, DuringAHandshakeItIsOverWhenItsQuestionIsAnswered) {
  for (Duration offset{}; offset < milliseconds(600) && !HasFailure(); offset += microseconds(7300)) {
    World world(quiet());
    world.run_for(offset);
    if (world.controller().state().link == LinkState::up) break;
    Ending ending(world);
    ending.wait(milliseconds(40));
    const std::size_t sent = world.wire().commands().size();
    world.run_for(milliseconds(50));
    EXPECT_LE(world.wire().commands().size(), sent + 1) << world.replay();
    EXPECT_NE(world.controller().state().link, LinkState::down) << "the handshake was told that it had failed";
  }
}

TEST(WindDown, SpeedsChangedForAMotionAreTheOldOnesAgain) {
  for (const AtExit policy : {AtExit::stop, AtExit::finish}) {
    World world(with(policy));
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    const auto before = execute(world, {"?:D1"});
    ASSERT_EQ(before.size(), 1u);
    MoveRequest move = move_of(world, {{1, 10000}}, true);
    move.moves[0].profile = SpeedProfile{pulses(500), pulses(7000), 70};
    world.controller().move(std::move(move), world.now(), [](Result<Motion>) {});
    world.run_for(milliseconds(400));
    // A caller asks without end, so that the restore of the old speeds waits for its turn.
    world.controller().execute({std::vector<std::string>(100, "?:D1"), world.context("asker")}, world.now(),
                               [](const ExecuteEvent&) {});
    Ending ending(world);
    EXPECT_EQ(ending.wait().motions.size(), 1u) << world.replay();
    EXPECT_EQ(written(world, "D:1" + before.front()), 1) << world.replay();
  }
}

// The gateway ends at any instant of busy use on a bad line, under every interpretation of the manual.
class WindDownSeeds : public testing::TestWithParam<AtExit> {};

TEST_P(WindDownSeeds, NothingStartsAndEveryMotionHasItsOutcome) {
  for (std::uint64_t seed = 1; seed <= 300 && !HasFailure(); ++seed) {
    auto setup = drawn_setup(seed, Faults::hostile());
    setup.profile.at_exit = GetParam();
    World world(setup);
    Callers callers(world);
    callers.act_for(milliseconds(world.random().between(1, 20'000)));
    const std::size_t begun_after = world.wire().commands().size();
    const TimePoint begun = world.now();
    Ending ending(world);
    const WindDownReport report = ending.wait();
    const bool seen = !report.problem && std::ranges::none_of(report.motions, [](const Motion& motion) {
      return motion.state == MotionState::unknown;
    });
    for (const Motion& motion : world.controller().motions()) {
      EXPECT_TRUE(is_outcome(motion.state)) << motion.id << "\n" << world.replay();
    }
    const Duration limit = Controller::kStopLimit + seconds(7);
    if (GetParam() == AtExit::finish) {
      EXPECT_LE(world.now() - begun, Controller::kFinishLimit + limit) << world.replay();
    } else {
      EXPECT_LE(world.now() - begun, limit) << world.replay();
      EXPECT_EQ(motion_lines(world, begun_after), 0) << world.replay();
    }
    for (const int axis : kAllAxes.list()) {
      EXPECT_TRUE(!seen || !world.device().busy(axis)) << axis << "\n" << world.replay();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Hostile, WindDownSeeds, testing::Values(AtExit::stop, AtExit::finish));

}  // namespace
}  // namespace axisgate::simulation
