// Tests of motions to saved positions: the position is read twice, checked against the expected coordinates and the
// envelope, and watched like any motion (manual 127) to 136)).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::milliseconds;
using std::chrono::seconds;

using Coordinates = std::map<int, std::int64_t>;

class ToPositions : public testing::Test {
 protected:
  explicit ToPositions(const simulation::Setup& setup = quiet()) : world(setup) { EXPECT_TRUE(world.run_until_up()); }

  std::vector<std::string> exec(const std::string& line) {
    auto said = execute(world, {line});
    world.run_for(milliseconds(200));  // until the end of the transaction
    return said;
  }

  GoToPositionRequest to(bool place, int number, Coordinates expected) const {
    return {place, number, std::move(expected), world.context("tester")};
  }

  // Returns the motion at its outcome, or only its problem if it never started.
  Motion go(GoToPositionRequest request) {
    auto answer = std::make_shared<std::optional<Result<Motion>>>();
    world.controller().go_to_position(std::move(request), world.now(),
                                      [answer](const Result<Motion>& motion) { *answer = motion; });
    EXPECT_TRUE(world.run_until([&] { return answer->has_value(); }, seconds(30))) << world.replay();
    Motion motion;
    if (!answer->value_or(fail(Reason::internal, "no answer"))) {
      motion.problem = (*answer)->error();
      motion.state = MotionState::failed;
      return motion;
    }
    const MotionId id = (**answer)->id;
    EXPECT_TRUE(world.run_until([&] { return is_outcome(world.controller().find_motion(id)->state); }, seconds(30)))
        << world.replay();
    EXPECT_TRUE(world.violations().empty()) << world.violations().front() << "\n" << world.replay();
    return *world.controller().find_motion(id);
  }

  std::vector<std::int64_t> stands() {
    return {world.device().position(1), world.device().position(2), world.device().position(3)};
  }

  World world;
};

TEST_F(ToPositions, AllAxesReachThePlaceTogether) {
  moved(world, {{1, 3000}, {2, -2000}, {3, 500}});
  exec("PIT:SET,7");
  moved(world, {{1, -3000}, {2, 100}});
  const Motion motion = go(to(true, 7, {{1, 3000}, {2, -2000}, {3, 500}}));
  EXPECT_EQ(motion.state, MotionState::succeeded) << world.replay();
  EXPECT_EQ(motion.kind, MotionKind::move);
  EXPECT_EQ(motion.axes, kAllAxes);
  EXPECT_THAT(stands(), testing::ElementsAre(3000, -2000, 500));
  ASSERT_EQ(motion.results.size(), 3u);
  EXPECT_EQ(motion.results[1].target_pulses, -2000);
  EXPECT_EQ(motion.results[1].command_pulses, -2000);
  EXPECT_TRUE(motion.results[0].completion_seen);
  EXPECT_EQ(written(world, "PIT:GET,7"), 2);
  EXPECT_EQ(written(world, "PIT:GRT,7"), 1);
}

TEST_F(ToPositions, CoordinatesAreOfTheirOwn) {
  moved(world, {{1, 1000}});
  exec("PAV:SET,2");
  exec("R:1");
  EXPECT_EQ(go(to(false, 2, {{1, 1000}, {2, 0}, {3, 0}})).state, MotionState::succeeded) << world.replay();
  EXPECT_EQ(world.device().position(1), 1000);
  EXPECT_EQ(written(world, "PAV:GRT,2"), 1);
  EXPECT_EQ(written(world, "PIT:"), 0);
}

// Manual 129), 130): the place stays where it is, and its coordinates are computed again.
TEST_F(ToPositions, APlaceStaysWhereItIsWhenCoordinatesAreSetAnew) {
  moved(world, {{1, 1000}});
  exec("PIT:SET,1");
  moved(world, {{1, 500}});
  exec("R:1");
  const Motion compared = go(to(true, 1, {{1, 1000}, {2, 0}, {3, 0}}));
  EXPECT_EQ(reason_of(compared), Reason::epoch_passed) << world.replay();
  EXPECT_THAT(compared.problem->message, testing::HasSubstr("reports -500,0,0 for number 1 of its positions (PIT:)"));
  EXPECT_EQ(world.device().position(1), 0);
  const Motion motion = go(to(true, 1, {}));
  EXPECT_EQ(motion.state, MotionState::succeeded) << world.replay();
  EXPECT_EQ(motion.results[0].target_pulses, -500);
  EXPECT_EQ(world.device().position(1), -500);
}

TEST_F(ToPositions, NothingMovesWhereARestartHasEmptiedThePlace) {
  moved(world, {{1, 1000}});
  exec("PIT:SET,1");
  exec("PAV:SET,1");
  const std::uint64_t epoch = world.controller().state().device_epoch;
  const TimePoint before = world.now();
  world.power_cycle();
  ASSERT_TRUE(world.run_until([&] { return world.controller().state().device_epoch > epoch; }, seconds(20)));
  EXPECT_GT(world.controller().state().epoch_began, before);
  for (const Coordinates& expected : {Coordinates{{1, 1000}, {2, 0}, {3, 0}}, Coordinates()}) {
    const Motion motion = go(to(true, 1, expected));
    EXPECT_EQ(reason_of(motion), Reason::epoch_passed) << world.replay();
    EXPECT_EQ(motion.problem->message, "the controller holds nothing under number 1 of its positions (PIT:)");
    EXPECT_EQ(motion.problem->sent, "PIT:GET,1");
    EXPECT_EQ(motion.problem->wire_reply, "NG");
  }
  EXPECT_EQ(written(world, "PIT:G,") + written(world, "PIT:GRT"), 0);
  // Coordinates survive the restart (ERRATA.md, 128) 133)).
  EXPECT_EQ(go(to(false, 1, {{1, 1000}, {2, 0}, {3, 0}})).state, MotionState::succeeded) << world.replay();
}

TEST_F(ToPositions, ANumberThatSomebodyElseHasUsed) {
  exec("PAV:SET,1");
  moved(world, {{2, 40}});
  exec("PAV:SET,1");
  EXPECT_EQ(reason_of(go(to(false, 1, {{1, 0}, {2, 0}, {3, 0}}))), Reason::epoch_passed) << world.replay();
  EXPECT_EQ(written(world, "PAV:GRT"), 0);
}

// One byte lost on the line would change the place.
TEST_F(ToPositions, WhatIsToldOnceIsNotBelieved) {
  moved(world, {{1, 1000}});
  exec("PAV:SET,1");
  world.wire().set_script([done = false](LineKind kind, const std::string& line) mutable -> Scripted {
    if (done || kind != LineKind::reply || line != "1000,0,0") return {};
    done = true;
    return {.drop = false, .delay = {}, .instead = "100,0,0\r\n"};
  });
  EXPECT_EQ(go(to(false, 1, {})).state, MotionState::succeeded) << world.replay();
  EXPECT_EQ(world.device().position(1), 1000);
  EXPECT_EQ(written(world, "PAV:GET,1"), 3);
}

TEST_F(ToPositions, RefusedBeforeAnythingIsSent) {
  for (const int number : {0, 21, -1}) EXPECT_EQ(reason_of(go(to(true, number, {}))), Reason::out_of_range) << number;
  GoToPositionRequest old = to(true, 1, {});
  old.context.frame_epoch = world.controller().state().frame_epoch + 1;
  EXPECT_EQ(reason_of(go(old)), Reason::epoch_passed);
  EXPECT_EQ(reason_of(go(to(true, 1, {{1, 0}, {8, 5}}))), Reason::unknown_axis) << "a damaged file of positions";
  EXPECT_EQ(written(world, "PIT:"), 0) << world.replay();
}

TEST_F(ToPositions, NgIsExplained) {
  exec("PAV:SET,1");
  moved(world, {{1, 100}});
  bool pressed = false;
  world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
    if (!pressed && kind == LineKind::command && line.starts_with("PAV:GRT")) {
      pressed = true;
      world.device().press_emergency(world.now());
    }
    return {};
  });
  const Motion motion = go(to(false, 1, {}));
  EXPECT_EQ(reason_of(motion), Reason::emergency_stopped) << world.replay();
  EXPECT_EQ(motion.problem->sent, "PAV:GRT,1");
  EXPECT_EQ(world.device().position(1), 100);
}

// The answer to the start is lost, and the start is not sent again.
TEST_F(ToPositions, AStartWhoseAnswerIsLost) {
  exec("PAV:SET,1");
  moved(world, {{1, 2000}});
  world.wire().set_script(drop_first(world, LineKind::reply, "PAV:GRT"));
  EXPECT_EQ(go(to(false, 1, {})).state, MotionState::succeeded) << world.replay();
  EXPECT_EQ(written(world, "PAV:GRT"), 1);
  moved(world, {{1, 2000}});
  world.wire().set_script(drop_first(world, LineKind::command, "PAV:GRT"));
  EXPECT_EQ(go(to(false, 1, {})).state, MotionState::unknown) << world.replay();
  EXPECT_EQ(world.device().position(1), 2000);
}

// A stop comes while the position is read.
TEST_F(ToPositions, AStopBeforeTheStart) {
  exec("PAV:SET,1");
  moved(world, {{1, 2000}});
  bool stopping = false;
  world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
    if (stopping || kind != LineKind::command || !line.starts_with("PAV:GET")) return {};
    stopping = true;
    world.at(world.now(),
             [this] { world.controller().stop({}, world.context("stopper"), world.now(), [](const StopReport&) {}); });
    return {};
  });
  EXPECT_EQ(reason_of(go(to(false, 1, {}))), Reason::stopped) << world.replay();
  EXPECT_EQ(world.outcomes().back().state, MotionState::stopped);
  EXPECT_EQ(written(world, "PAV:GRT"), 0) << world.replay();
  EXPECT_EQ(world.device().position(1), 2000);
}

TEST_F(ToPositions, AStopOnTheWay) {
  exec("PAV:SET,1");
  moved(world, {{1, 20'000}});
  const std::size_t before = world.outcomes().size();
  world.controller().go_to_position(to(false, 1, {}), world.now(), [](const Result<Motion>&) {});
  ASSERT_TRUE(world.run_until([&] { return world.device().busy(1); }, seconds(5)));
  (void)stopped(world);
  EXPECT_EQ(outcome_of(world, before + 1).state, MotionState::stopped) << world.replay();
  EXPECT_GT(world.device().position(1), 0);
}

class ToPositionsWithin : public ToPositions {
 protected:
  static simulation::Setup bounded() {
    simulation::Setup setup = quiet();
    setup.profile.axes[0].travel_maximum = pulses(5000);
    setup.profile.axes[1].maximum_speed = pulses(2000);
    return setup;
  }
  ToPositionsWithin() : ToPositions(bounded()) {}
};

TEST_F(ToPositionsWithin, OutsideTheTravelEnvelope) {
  exec("PSET:1+P6000");
  exec("PAV:SET,1");
  exec("PSET:1+P0");
  // Refused before the position is read, and again when the controller reports it.
  EXPECT_EQ(reason_of(go(to(false, 1, {{1, 6000}, {2, 0}, {3, 0}}))), Reason::outside_travel);
  EXPECT_EQ(written(world, "PAV:GET"), 0);
  EXPECT_EQ(world.controller().check(to(false, 1, {{1, 6000}})).error().reason, Reason::outside_travel);
  EXPECT_TRUE(world.controller().check(to(false, 1, {{1, 5000}})));
  EXPECT_EQ(reason_of(go(to(false, 1, {}))), Reason::outside_travel);
  EXPECT_EQ(written(world, "PAV:GRT"), 0) << world.replay();
}

// Slowed down for this motion alone, like a move (manual 68), 89)).
TEST_F(ToPositionsWithin, NoFasterThanAllowed) {
  exec("PAV:SET,1");
  moved(world, {{2, 4000}});
  const auto speeds = [this] {
    world.run_for(seconds(1));
    return exec("?:D").front();
  };
  const std::string before = speeds();
  const TimePoint begin = world.now();
  EXPECT_EQ(go(to(false, 1, {})).state, MotionState::succeeded) << world.replay();
  EXPECT_GE(world.now() - begin, seconds(2));
  EXPECT_EQ(speeds(), before);
}

}  // namespace
}  // namespace axisgate::simulation
