// Hazards of motions: lost answers and completions, stale setpoints, underruns. The numbers are those of
// device/shrc203/HAZARDS.md.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::AnyOf;
using testing::ElementsAre;

TEST(Hazard, H03_OkOfGoLostButTheMoveStarted) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.wire().set_script(drop_first(world, LineKind::reply, "G:"));
  move_by(world, {{1, 4000}, {2, 100}});
  EXPECT_EQ(outcome_of(world, 1).state, MotionState::succeeded) << world.replay();
  EXPECT_EQ(world.barriers(), 1u);
  EXPECT_EQ(written(world, "G:"), 1) << "sent again\n" << world.replay();
  EXPECT_EQ(world.device().starts(1), 1);
  EXPECT_EQ(world.device().position(1), 4000);
}

void home_with_lost_ok(World& world, std::int64_t from) {
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  moved(world, {{1, from}});
  world.wire().set_script(drop_first(world, LineKind::reply, "HRT"));
  world.controller().home({AxisSet::of(1), world.context("tester")}, world.now(), [](Result<Motion>) {});
}

TEST(Hazard, H03_OkOfHomeLostAndItIsSeenToRun) {
  World world(quiet());
  home_with_lost_ok(world, 1'000'000);
  EXPECT_EQ(outcome_of(world, 2).state, MotionState::succeeded) << world.replay();
  EXPECT_EQ(written(world, "HRT"), 1) << "sent again\n" << world.replay();
  EXPECT_TRUE(world.controller().state().axis(1).homed);
}

// The homing ends before the line is certain again: an axis at 0 may also have lost its power, so the outcome is
// unknown.
TEST(Hazard, H03_OkOfHomeLostAndItIsOverUnseen) {
  World world(quiet());
  home_with_lost_ok(world, 4000);
  EXPECT_EQ(outcome_of(world, 2).state, MotionState::unknown) << world.replay();
  EXPECT_EQ(written(world, "HRT"), 1) << "sent again\n" << world.replay();
  EXPECT_FALSE(world.controller().state().axis(1).homed);
}

TEST(Hazard, H03_GoItselfLost) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.wire().set_script(drop_first(world, LineKind::command, "G:"));
  move_by(world, {{1, 4000}});
  EXPECT_THAT(outcome_of(world, 1).state, AnyOf(MotionState::failed, MotionState::unknown)) << world.replay();
  EXPECT_EQ(written(world, "G:"), 1) << "sent again\n" << world.replay();
  EXPECT_EQ(world.device().starts(1), 0);
}

TEST(Hazard, H03_HomeItselfLostWhereTheAxisStandsAtItsOrigin) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.wire().set_script(drop_first(world, LineKind::command, "HRT"));
  world.controller().home({AxisSet::of(1), world.context("tester")}, world.now(), [](Result<Motion>) {});
  EXPECT_THAT(outcome_of(world, 1).state, AnyOf(MotionState::failed, MotionState::unknown))
      << "nothing ran, and it stands at 0\n"
      << world.replay();
  EXPECT_EQ(written(world, "HRT"), 1);
  EXPECT_FALSE(world.controller().state().axis(1).homed);
}

TEST(Hazard, H04_CompletionsLost) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.wire().set_script([](LineKind kind, const std::string&) { return Scripted{kind == LineKind::notice, {}, {}}; });
  moved(world, {{1, 3000}, {3, -3000}});
  world.controller().home({{}, world.context("tester")}, world.now(), [](Result<Motion>) {});
  EXPECT_EQ(outcome_of(world, 2).state, MotionState::succeeded) << world.replay();
  EXPECT_TRUE(world.completions().empty());
  EXPECT_FALSE(world.outcomes()[0].results[0].completion_seen);
}

// Twenty readings in a row may fail; one that makes sense ends the row.
TEST(Hazard, H04_OneGoodReadingAmongManyBadOnes) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  int readings = 0;
  bool moves = false;
  world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
    if (kind == LineKind::command && line.starts_with("G:")) moves = true;
    if (kind == LineKind::notice) return {.drop = true, .delay = {}, .instead = {}};
    if (!moves || kind != LineKind::reply || world.wire().commands().back() != "Q:SPC") return {};
    return {.drop = readings++ % 21 != 20 && readings < 60, .delay = {}, .instead = {}};
  });
  stage::MoveRequest slow = move_of(world, {{1, 200'000}}, true);
  slow.moves[0].profile = stage::SpeedProfile{pulses(500), pulses(1000), 100};
  world.controller().move(slow, world.now(), [](Result<Motion>) {});
  EXPECT_EQ(outcome_of(world, 1, std::chrono::minutes(10)).state, MotionState::succeeded) << world.replay();
  EXPECT_GT(readings, 42) << world.replay();
}

TEST(Hazard, H05_HomeOfTwoAxesEndsTheSecondFirst) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  moved(world, {{1, 90000}, {2, 10}});
  const std::size_t before = world.completions().size();
  world.controller().home({AxisSet::of(1) | AxisSet::of(2), world.context("tester")}, world.now(),
                          [](Result<Motion>) {});
  ASSERT_TRUE(world.run_until([&] { return world.completions().size() == before + 1; }, seconds(30)));
  EXPECT_EQ(world.completions()[before].axis, 2);
  EXPECT_EQ(world.outcomes().size(), 1u) << "ended by the first of two axes\n" << world.replay();
  const auto home = outcome_of(world, 2);
  EXPECT_EQ(home.state, MotionState::succeeded) << world.replay();
  ASSERT_EQ(world.completions().size(), before + 2);
  EXPECT_EQ(world.completions()[before + 1].axis, 1);
  EXPECT_TRUE(home.results[0].completion_seen && home.results[1].completion_seen);
  EXPECT_EQ(written(world, "HRT:A"), 1);
}

TEST(Hazard, H06_HomeTwice) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  const HomeRequest first{AxisSet::of(1), world.context("one")};
  world.controller().home(first, world.now(), [](Result<Motion>) {});
  world.run_for(milliseconds(50));
  const std::size_t lines = world.wire().commands().size();
  std::optional<Result<Motion>> second;
  world.controller().home({kAllAxes, world.context("two")}, world.now(), [&](Result<Motion> m) { second = m; });
  ASSERT_TRUE(second.has_value()) << "not refused at once";
  ASSERT_FALSE(second->has_value());
  EXPECT_EQ(second->error().reason, Reason::axis_busy);
  EXPECT_EQ(world.wire().commands().size(), lines);
  EXPECT_EQ(outcome_of(world, 1).state, MotionState::succeeded) << world.replay();
  EXPECT_EQ(written(world, "HRT"), 1);
}

TEST(Hazard, H12_StaleSetpointExecutionSettingIsClearedFirst) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  foreign_traffic(world, {"M:1+P500", "A:3+P700"});
  const std::size_t first = world.wire().commands().size();
  moved(world, {{2, 1000}});
  const auto& lines = world.wire().commands();
  const auto cleared = std::find(lines.begin(), lines.end(), "GC:B");
  ASSERT_NE(cleared, lines.end()) << world.replay();
  EXPECT_LT(cleared, std::find(lines.begin() + static_cast<std::ptrdiff_t>(first), lines.end(), "MP:2+P1000"));
  EXPECT_EQ(world.device().position(1), 0);
  EXPECT_EQ(world.device().position(3), 0);
}

TEST(Hazard, H12_StaleSetpointOfTheSameAxisIsReplaced) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  foreign_traffic(world, {"M:1+P500"});
  moved(world, {{1, 70}});
  EXPECT_EQ(world.device().position(1), 70);
  EXPECT_EQ(world.device().starts(1), 1);
}

// Stale setpoints that no documented command clears: no motion is started over them, on any axis.
class HazardH12 : public testing::TestWithParam<const char*> {};

TEST_P(HazardH12, StaleSetpointThatCannotBeClearedRefusesMotion) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  foreign_traffic(world, {GetParam()});
  const std::size_t first = world.wire().commands().size();
  std::optional<Result<Motion>> started;
  world.controller().move(move_of(world, {{2, 1000}}, true), world.now(), [&](Result<Motion> m) { started = m; });
  EXPECT_EQ(reason_of(outcome_of(world, 1)), Reason::stale_setpoint) << world.replay();
  ASSERT_TRUE(started && !started->has_value());
  EXPECT_NE(started->error().hint, "") << "without a remedy";
  world.controller().home({AxisSet::of(2), world.context("tester")}, world.now(), [](Result<Motion>) {});
  EXPECT_EQ(reason_of(outcome_of(world, 2)), Reason::stale_setpoint) << world.replay();
  EXPECT_EQ(motion_lines(world, first), 0) << world.replay();
  for (int axis = 1; axis <= kAxisCount; ++axis) EXPECT_EQ(world.device().starts(axis), 0);
}

INSTANTIATE_TEST_SUITE_P(Settings, HazardH12,
                         testing::Values("MP:1+P500", "AP:3+P500", "KP:A+P500+P500", "J:1+", "AP:2+P500", "WT:1,5"));

TEST(Hazard, H13_OkWhereOkDWasDue) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  int setters = 0;
  world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
    const bool fourth = kind == LineKind::command && line.starts_with("KP:") && ++setters == 4;
    return {.drop = false, .delay = fourth ? milliseconds(400) : milliseconds(0), .instead = {}};
  });
  world.controller().run_path(line_of(world, 8), world.now(), [](Result<Motion>) {});
  const Motion path = outcome_of(world, 1);
  EXPECT_EQ(path.state, MotionState::succeeded) << world.replay();
  EXPECT_EQ(path.underruns, 1) << world.replay();
  EXPECT_EQ(path.segments_done, 8);
  std::vector<int> underruns, done;
  for (const auto& step : world.progress()) {
    if (step.step == PathProgress::Step::underrun) underruns.push_back(step.segment);
    if (step.step == PathProgress::Step::done) done.push_back(step.segment);
  }
  EXPECT_THAT(underruns, ElementsAre(4));
  EXPECT_THAT(done, ElementsAre(1, 2, 3, 4, 5, 6, 7, 8));
  EXPECT_EQ(world.device().starts(2), 8);
  EXPECT_EQ(world.device().position(1), 4000);
  EXPECT_EQ(world.device().position(2), 16000);
}

// An additional completion must not make the path refill early and overwrite the waiting segment.
TEST(Hazard, H56_DoubledCompletionsOfAPath) {
  auto setup = quiet();
  setup.faults.double_notice = 1;
  World world(setup);
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.controller().run_path(line_of(world, 12), world.now(), [](Result<Motion>) {});
  const Motion path = outcome_of(world, 1);
  EXPECT_EQ(path.state, MotionState::succeeded) << world.replay();
  EXPECT_EQ(world.device().starts(2), 12) << world.replay();
  EXPECT_EQ(world.device().position(2), 24000);
}

// The limit may strike at any time, even in the last pulses: only the target itself is success.
TEST(Hazard, H44_LimitNearTheTarget) {
  int succeeded = 0, failed = 0;
  for (int before_end = 0; before_end < 300 && !HasFailure(); before_end += 7) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    move_by(world, {{1, 20000}, {2, 100}});
    world.run_for(milliseconds(700 - before_end));
    world.device().set_limit(1, +1, true, world.now());
    const Motion motion = outcome_of(world, 1);
    const bool there = world.device().position(1) == 20000;
    EXPECT_TRUE(there || motion.state != MotionState::succeeded) << world.replay();
    (motion.state == MotionState::succeeded ? succeeded : failed) += 1;
  }
  EXPECT_GT(succeeded, 0) << "always too late";
  EXPECT_GT(failed, 10) << "never in time";
}

TEST(Hazard, H44_LimitInAPath) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.controller().run_path(line_of(world, 12), world.now(), [](Result<Motion>) {});
  ASSERT_TRUE(world.run_until([&] { return written(world, "KP:") == 6; }, seconds(5))) << world.replay();
  world.device().set_limit(2, +1, true, world.now());
  const Motion path = outcome_of(world, 1);
  EXPECT_NE(path.state, MotionState::succeeded) << world.replay();
  EXPECT_LT(path.segments_done, 12);
}

TEST(Hazard, H44_LimitStopIsNoSuccess) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  move_by(world, {{1, 500000}});
  world.run_for(seconds(1));
  world.device().set_limit(1, +1, true, world.now());
  const Motion motion = outcome_of(world, 1);
  EXPECT_EQ(motion.state, MotionState::failed) << world.replay();
  EXPECT_EQ(reason_of(motion), Reason::limit_detected);
}

// A straight line that is set again for other axes replaces the whole earlier one (manual 2. 2), 24)). The axis that it
// no longer names stays where it is, and the next motion of that axis begins there.
TEST(Motions, ALineSetAnewForOtherAxes) {
  auto setup = quiet();
  setup.profile.axes[1].travel_minimum = pulses(-500'000);
  setup.profile.axes[1].travel_maximum = pulses(500'000);
  World world(setup);
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  const std::vector<std::string> lines = {"K:A+P100-P300000", "K:B+P50+P70", "G:D"};
  EXPECT_THAT(execute(world, lines), ElementsAre("OK", "OK", "OK")) << world.replay();
  EXPECT_EQ(outcome_of(world, 1).state, MotionState::succeeded) << world.replay();
  EXPECT_EQ(world.device().position(1), 50);
  EXPECT_EQ(world.device().position(2), 0);
  EXPECT_EQ(world.device().position(3), 70);
  const std::size_t first = world.wire().commands().size();
  auto further = lines;
  further.insert(further.end(), {"MP:2+P700000", "G:2"});
  EXPECT_THAT(execute(world, further), ElementsAre("OUTSIDE_TRAVEL"));
  EXPECT_EQ(reason_of(outcome_of(world, 2)), Reason::outside_travel);
  EXPECT_EQ(motion_lines(world, first), 0) << world.replay();
  EXPECT_EQ(world.device().position(2), 0);
}

// The speed of a move stays in the controller when the line is lost during the move: the next move must run at the old
// speed.
TEST(Hazard, H28_SpeedsOfAMotionWhoseLineWasLost) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  MoveRequest request = move_of(world, {{1, 5000}}, true);
  request.moves[0].profile = SpeedProfile{pulses(200), pulses(2000), 30};
  world.controller().move(request, world.now(), [](const Result<Motion>&) {});
  world.run_for(seconds(1));
  ASSERT_EQ(world.device().maximum_speed(1), 2000) << world.replay();
  foreign_traffic(world, {});
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.run_for(seconds(5));
  moved(world, {{1, 100}});
  EXPECT_EQ(world.device().maximum_speed(1), 50'000) << world.replay();
}

// No completion is documented for a motion from the execution buffer (manual 67) M:), so the gateway does not wait for
// one.
TEST(Hazard, H01_ACallersOwnMoveLeavesNoNumberOutstanding) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  execute(world, {"M:1+P1000", "G:1"});
  ASSERT_EQ(outcome_of(world, 1).state, MotionState::succeeded) << world.replay();
  const TimePoint asked = world.now();
  execute(world, {"?:AXIS"});
  EXPECT_LT(world.now() - asked, milliseconds(50)) << world.replay();
}

}  // namespace
}  // namespace axisgate::simulation
