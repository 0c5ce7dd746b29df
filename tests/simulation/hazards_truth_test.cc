// Outcomes, stops and stale setpoints, one rule each. Each test fails without the guard that it tests
// (tests/guards/table.cc).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;

Setup with_option(const char* name, const char* value) {
  auto setup = quiet();
  EXPECT_TRUE(setup.options.set(name, value)) << name;
  return setup;
}

// Runs until axis 1 is at `target` and still settles.
void settle_at(World& world, std::int64_t target) {
  ASSERT_TRUE(world.run_until([&] { return world.device().position(1) == target; }, seconds(60))) << world.replay();
  ASSERT_TRUE(world.device().busy(1)) << "no settling to look at";
}

TEST(Hazard, H44_AnErrorAtTheVeryTargetIsNoSuccess) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  move_by(world, {{1, 3000}});
  settle_at(world, 3000);
  world.device().set_error(1, simulator::AxisError::overflow, true, world.now());
  EXPECT_EQ(reason_of(outcome_of(world, 1)), Reason::device_error) << world.replay();
}

// One flipped bit turns the B of an axis that settles at its target into an R, and no completion confirms it.
TEST(Hazard, H04_OneMisreadReadyIsNotTheEnd) {
  int misread = 0;
  for (std::int64_t target = 3000; target < 3400 && !HasFailure(); target += 10) {
    auto setup = quiet();
    setup.profile.moving_poll = milliseconds(5);
    setup.baud = setup.profile.baud = 115200;
    World world(setup);
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    world.wire().set_script([&, done = false](LineKind kind, const std::string& line) mutable -> Scripted {
      if (kind == LineKind::notice) return {.drop = true, .delay = {}, .instead = {}};
      const auto busy = line.find(",B,");
      if (done || kind != LineKind::reply || busy == std::string::npos) return {};
      if (world.device().position(1) != target) return {};
      done = true;
      ++misread;
      return {.drop = false, .delay = {}, .instead = std::string(line).replace(busy, 3, ",R,") + "\r\n"};
    });
    world.on_motion = [&](const Motion& motion) {
      EXPECT_FALSE(motion.state == MotionState::succeeded && world.device().busy(1)) << world.replay();
    };
    moved(world, {{1, target}});
  }
  EXPECT_GT(misread, 0) << "no reading has met the settling";
}

// For a while after the start the status is still the earlier one (manual 85) G:).
TEST(Hazard, H03_AnOldReadyAfterTheStartIsNotTheEnd) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  std::optional<TimePoint> started;
  world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
    if (kind == LineKind::command && line.starts_with("G:")) started = world.now();
    const bool reading = kind == LineKind::reply && world.wire().commands().back().starts_with("Q:S");
    if (!reading || !started || world.now() > *started + milliseconds(250)) return {};
    return {.drop = false, .delay = {}, .instead = "P0,P0,P0,0,0,0,R,R,R\r\n"};
  });
  moved(world, {{1, 500000}});
}

// Changes the OK to a start into NG on the line, while the axis moves.
void misread_start(const std::string& start, const std::function<void(World&)>& begin) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  moved(world, {{1, 200000}});
  world.wire().set_script([&, done = false](LineKind kind, const std::string&) mutable -> Scripted {
    if (done || kind != LineKind::reply || !world.wire().commands().back().starts_with(start)) return {};
    done = true;
    return {.drop = false, .delay = {}, .instead = "NG\r\n"};
  });
  begin(world);
  EXPECT_EQ(outcome_of(world, 2).state, MotionState::succeeded) << world.replay();
  EXPECT_EQ(written(world, start), start == "G:" ? 2 : 1) << "sent again\n" << world.replay();
}

TEST(Hazard, H03_ARefusalOfAGoThatMoves) {
  misread_start("G:", [](World& world) { move_by(world, {{1, -100000}}); });
}

TEST(Hazard, H03_ARefusalOfAHomeThatMoves) {
  misread_start("HRT", [](World& world) { home(world, AxisSet::of(1)); });
}

// A set whose OK was lost is looked up, not sent a second time blindly.
TEST(Hazard, H10_ASetThatArrivedIsNotSentAgain) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.wire().set_script(drop_first(world, LineKind::reply, "MP:"));
  moved(world, {{1, 4000}});
  EXPECT_EQ(written(world, "MP:"), 1) << world.replay();
}

// A stop comes while the next line of a motion waits for another caller's question.
TEST(Hazard, H35_StopWhileALineWaitsItsTurn) {
  for (Duration offset{}; offset < milliseconds(100) && !HasFailure(); offset += microseconds(610)) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    moved(world, {{1, 100}});
    for (int i = 0; i < 30; ++i) {
      world.controller().execute({{i % 2 ? "?:V" : "?:D1"}, world.context("asker " + std::to_string(i))}, world.now(),
                                 [](const ExecuteEvent&) {});
    }
    home(world, AxisSet::of(1));
    world.run_for(offset);
    const bool gone = written(world, "HRT:") > 0;
    EXPECT_FALSE(stopped(world).problem) << world.replay();
    EXPECT_EQ(written(world, "HRT:"), gone ? 1 : 0) << "sent after the stop\n" << world.replay();
  }
}

// A queued motion waits for the end of another motion: if it is stopped, it ends at once.
TEST(Hazard, H37_AStoppedMotionThatWaitsEndsAtOnce) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  move_by(world, {{1, 500000}});
  world.run_for(seconds(1));
  move_by(world, {{2, 500}});
  world.controller().stop(AxisSet::of(2), world.context("stopper"), world.now(), [](const StopReport&) {});
  ASSERT_EQ(world.outcomes().size(), 1u) << world.replay();
  EXPECT_EQ(world.outcomes()[0].axes, AxisSet::of(2));
  EXPECT_EQ(world.outcomes()[0].state, MotionState::stopped);
  EXPECT_TRUE(world.device().busy(1));
}

// The set was lost, and the stop comes before that is detected: the set is not sent again.
TEST(Hazard, H35_NothingIsSetAgainAfterAStop) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  moved(world, {{1, 700}});
  const std::size_t first = world.wire().commands().size();
  world.wire().set_script(drop_first(world, LineKind::command, "MP:"));
  move_by(world, {{1, 4000}});
  world.run_for(milliseconds(300));
  ASSERT_EQ(written(world, "MP:", first), 1) << world.replay();
  stopped(world);
  EXPECT_EQ(outcome_of(world, 2).state, MotionState::stopped) << world.replay();
  world.run_for(seconds(5));
  EXPECT_EQ(written(world, "MP:", first), 1) << world.replay();
}

TEST(Hazard, H17_AStopThatWasLostIsWrittenAgain) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  move_by(world, {{1, 500000}});
  world.run_for(seconds(1));
  world.wire().set_script(drop_first(world, LineKind::command, "L:"));
  const TimePoint asked = world.now();
  EXPECT_FALSE(stopped(world).problem) << world.replay();
  EXPECT_FALSE(world.device().busy(1));
  EXPECT_LT(world.now() - asked, seconds(2)) << world.replay();
}

// The manual leaves open whether L: clears the prebuffer: a kept segment is reported, and a started one is stopped.
TEST(Hazard, H14_AStopThatKeepsThePrebuffer) {
  for (const char* reading : {"kept", "starts_next"}) {
    World world(with_option("stop_keeps_prebuffer", reading));
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    auto path = line_of(world, 8);
    for (auto& segment : path.segments) segment.speed = pulses(2000);  // a second each, so that one always waits
    world.controller().run_path(path, world.now(), [](Result<Motion>) {});
    world.run_for(milliseconds(600));
    const StopReport report = stopped(world);
    EXPECT_EQ(outcome_of(world, 1).state, MotionState::stopped) << world.replay();
    const bool kept = report.problem && report.problem->reason == Reason::stale_setpoint;
    EXPECT_TRUE(kept || written(world, "L:") > 1) << reading << ": nobody looked\n" << world.replay();
    EXPECT_FALSE(world.device().busy(1) || world.device().busy(2)) << reading;
  }
}

TEST(Hazard, H38_StopsThatComeTogetherAreOne) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  move_by(world, {{1, 500000}});
  world.run_for(seconds(1));
  int told = 0;
  for (int i = 0; i < 100; ++i) {
    world.controller().stop({}, world.context("stopper"), world.now(),
                            [&](const StopReport& report) { told += report.problem ? 0 : 1; });
  }
  ASSERT_TRUE(world.run_until([&] { return told == 100; }, seconds(20))) << world.replay();
  EXPECT_EQ(written(world, "L:"), 1) << world.replay();
}

// A setpoint left in the controller by another program, by a failure, or by a caller's own lines is found before a
// motion.
class StaleSetpoint : public testing::Test {
 protected:
  StaleSetpoint() : world(quiet()) {
    EXPECT_TRUE(world.run_until_up()) << world.replay();
    moved(world, {{1, 100}});  // the registers are known from here on
  }
  void expect_refused() {
    const std::size_t before = world.outcomes().size();
    move_by(world, {{3, 1000}});
    EXPECT_EQ(reason_of(outcome_of(world, before + 1)), Reason::stale_setpoint) << world.replay();
    EXPECT_EQ(world.device().starts(3), 0);
  }
  World world;
};

TEST_F(StaleSetpoint, H12_BySomebodyElseWhileTheLineWasDown) {
  foreign_traffic(world, {"MP:2+P500"});
  expect_refused();
}

// Seed 805722: two motions of different axes search for stale setpoints, the second while the first still searches.
TEST(Hazard, H12_LookedForByTwoAtOnce) {
  for (int apart = 0; apart < 60 && !HasFailure(); apart += 2) {
    auto setup = quiet();
    setup.profile.busy_scope = setup.profile.prebuffer_scope = Scope::axis;
    for (const char* option : {"busy_scope", "prebuffer_scope"}) ASSERT_TRUE(setup.options.set(option, "axis"));
    World world(setup);
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    foreign_traffic(world, {"AP:3+P198"});
    const int starts = world.device().starts(3);
    move_by(world, {{3, 100}});
    world.run_for(milliseconds(apart));
    move_by(world, {{1, 100}});
    (void)outcome_of(world, 2);
    EXPECT_EQ(world.device().starts(3), starts) << apart << "\n" << world.replay();
  }
}

// A motion that clears stale setpoints keeps a setpoint that another motion has just set on its axes and not yet
// started.
TEST(Hazard, H12_ClearedBesideOthersThatSet) {
  for (int apart = 0; apart < 120 && !HasFailure(); ++apart) {
    auto setup = quiet();
    setup.profile.busy_scope = setup.profile.prebuffer_scope = Scope::axis;
    for (const char* option : {"busy_scope", "prebuffer_scope"}) ASSERT_TRUE(setup.options.set(option, "axis"));
    World world(setup);
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    foreign_traffic(world, {"M:3+P1", "A:1+P1"});
    std::vector<std::string> answers;
    world.controller().execute({{"M:3+P100", "G:3"}, world.context("anna")}, world.now(),
                               [&](const ExecuteEvent& event) {
                                 if (event.kind == ExecuteEvent::Kind::reply) answers.push_back(event.answer);
                               });
    move_by(world, {{1, 100}});
    world.run_for(milliseconds(apart));
    move_by(world, {{2, 100}});
    for (const int number : {1, 2, 3}) {
      EXPECT_EQ(outcome_of(world, number).state, MotionState::succeeded) << apart << "\n" << world.replay();
    }
    EXPECT_THAT(answers, ElementsAre("OK", "OK")) << apart << "\n" << world.replay();
    for (const int axis : {1, 2, 3}) EXPECT_EQ(world.device().position(axis), 100) << apart;
  }
}

TEST_F(StaleSetpoint, H12_ByAMotionWhoseStartWasLost) {
  world.wire().set_script(drop_first(world, LineKind::command, "G:"));
  move_by(world, {{2, 500}});
  EXPECT_EQ(outcome_of(world, 2).state, MotionState::failed) << world.replay();
  expect_refused();
}

TEST_F(StaleSetpoint, H12_ByACallersOwnLines) {
  execute(world, {"AP:2+P0", "MP:1+P300", "G:1"});  // axis 2 is already there
  expect_refused();
}

// An axis moves that the gateway did not start, and only the status shows it. An axis number does not, since it may
// belong to another axis.
TEST(Motions, NothingIsSetBeforeTheAxesStand) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  move_by(world, {{1, 500000}});
  world.run_for(milliseconds(500));
  world.device().set_limit(1, +1, true, world.now());
  EXPECT_EQ(reason_of(outcome_of(world, 1)), Reason::limit_detected);
  bool unheard = true;
  world.wire().set_script([&](LineKind kind, const std::string& text) {
    Scripted fault{.drop = unheard && kind != LineKind::command, .delay = {}, .instead = {}};
    if (kind == LineKind::reply && text.find(",B") != std::string::npos) fault.instead = text + "\r\n2\r\n";
    return fault;
  });
  world.device().receive("M:2+P60000\r\nG:2\r\n", world.now());
  unheard = false;
  move_by(world, {{2, 100}});
  EXPECT_EQ(outcome_of(world, 2).state, MotionState::succeeded) << world.replay();
  EXPECT_EQ(world.device().position(2), 60100);
}

// The late completion of a stopped move does not belong to the next one (manual 65) leaves open whether there is one).
// The axis is stationary, so no answer says that it did not stop.
TEST(Hazard, H57_AMoveWithoutTimeForALateCompletionIsToldSo) {
  World world(with_option("completion_after_stop", "none"));
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  move_by(world, {{1, 500'000}});
  world.run_for(milliseconds(500));
  world.controller().stop({}, world.context("stopper"), world.now(), [](const StopReport&) {});
  EXPECT_EQ(outcome_of(world, 1).state, MotionState::stopped);
  auto request = move_of(world, {{1, -300}}, true);
  request.context = world.context("tester", milliseconds(5));
  world.controller().move(std::move(request), world.now(), [](Result<Motion>) {});
  EXPECT_EQ(reason_of(outcome_of(world, 2)), Reason::completion_outstanding) << world.replay();
}

TEST(Hazard, H57_TheLateCompletionOfAStoppedMove) {
  for (int late = 150; late < 225 && !HasFailure(); late += 3) {
    auto setup = with_option("completion_after_stop", "sent");
    setup.baud = setup.profile.baud = 115200;
    World world(setup);
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    move_by(world, {{1, 500000}});
    world.run_for(seconds(1));
    world.wire().set_script([late, numbers = 0](LineKind kind, const std::string&) mutable -> Scripted {
      const bool of_the_stop = kind == LineKind::notice && ++numbers == 1;
      return {.drop = false, .delay = milliseconds(of_the_stop ? late : 0), .instead = {}};
    });
    EXPECT_FALSE(stopped(world).problem) << world.replay();
    EXPECT_EQ(outcome_of(world, 1).state, MotionState::stopped);
    move_by(world, {{1, 100000}});
    const Motion second = outcome_of(world, 2);
    EXPECT_EQ(second.state, MotionState::succeeded) << world.replay();
    world.run_for(seconds(1));
    EXPECT_EQ(std::ranges::count(world.completions(), second.id, &CompletionSeen::motion), 1) << late << "\n"
                                                                                              << world.replay();
  }
}

Setup axes_for_themselves() {
  auto setup = with_option("busy_scope", "axis");
  EXPECT_TRUE(setup.options.set("prebuffer_scope", "controller"));
  setup.profile.busy_scope = Scope::axis;
  return setup;
}

// If the controller has only one set of prebuffers, one running motion owns them all.
TEST(Hazard, H51_BesideAMotionAnotherIsSetInTheExecutionBuffer) {
  World world(axes_for_themselves());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  move_by(world, {{1, 300000}});
  world.run_for(milliseconds(500));
  move_by(world, {{2, 1000}});
  EXPECT_EQ(outcome_of(world, 1).axes, AxisSet::of(2)) << world.replay();
  EXPECT_EQ(written(world, "MP:2"), 0) << world.replay();
  EXPECT_EQ(world.device().position(2), 1000);
}

TEST(Hazard, H51_APathRunsAlone) {
  World world(axes_for_themselves());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.controller().run_path(line_of(world, 20), world.now(), [](Result<Motion>) {});
  world.run_for(milliseconds(500));
  move_by(world, {{3, 1000}});
  EXPECT_EQ(outcome_of(world, 1).kind, MotionKind::path) << "not the first to end\n" << world.replay();
  EXPECT_EQ(outcome_of(world, 1).state, MotionState::succeeded);
  EXPECT_EQ(outcome_of(world, 2).state, MotionState::succeeded) << world.replay();
}

}  // namespace
}  // namespace axisgate::simulation
