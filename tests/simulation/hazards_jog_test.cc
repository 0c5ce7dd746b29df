// Hazards of jogs: axes that run until a caller stops them (manual 88) J:, 93) JD:). The numbers are those of
// device/shrc203/HAZARDS.md.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "server/access/leases.h"
#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;

constexpr Duration kRenewal = milliseconds(100);

Setup at_baud(int baud) {
  auto setup = quiet();
  setup.baud = setup.profile.baud = baud;
  return setup;
}

class HazardOfJogs : public testing::Test {
 protected:
  explicit HazardOfJogs(const simulation::Setup& setup = quiet()) : world(setup) { EXPECT_TRUE(world.run_until_up()); }

  using Axes = std::vector<JogRequest::Axis>;

  // Starts a jog and returns its number. `refused` is the reason if the start is refused.
  MotionId jog(const Axes& axes, RequestContext context) {
    return world.controller().jog({axes, std::move(context)}, world.now(), [this](const Result<Motion>& motion) {
      refused = motion ? Reason::unspecified : motion.error().reason;
    });
  }
  MotionId jog(const Axes& axes) { return jog(axes, world.context("anna")); }

  // Renews the jog as a working client does.
  void renew_for(MotionId id, Duration duration) {
    const TimePoint end = world.now() + duration;
    while (world.now() < end) {
      (void)world.controller().renew_jog(id, {}, world.now());
      renewed = world.now();
      world.run_for(std::min(kRenewal, end - world.now()));
    }
  }

  Motion outcome(MotionId id, Duration limit = seconds(5)) {
    EXPECT_TRUE(world.run_until([&] { return is_outcome(world.controller().find_motion(id)->state); }, limit))
        << world.replay();
    return *world.controller().find_motion(id);
  }

  World world;
  std::optional<Reason> refused;
  TimePoint renewed{};
};

TEST_F(HazardOfJogs, RunsWhileItIsRenewedAndEndsWhenItsCallerWants) {
  const MotionId id = jog({{1, 1, {}}});
  renew_for(id, seconds(3));
  EXPECT_EQ(refused, Reason::unspecified);
  EXPECT_TRUE(world.device().busy(1)) << world.replay();
  world.controller().end_jog(id, {}, world.now());
  EXPECT_EQ(outcome(id).state, MotionState::succeeded) << world.replay();
  EXPECT_FALSE(world.device().busy(1));
  // S is 1000 pulses/s, and the start took a few milliseconds of the three seconds.
  EXPECT_NEAR(static_cast<double>(world.device().position(1)), 3000, 100) << world.replay();
}

TEST_F(HazardOfJogs, BothWaysAtOnce) {
  const MotionId id = jog({{1, -1, {}}, {3, 1, {}}});
  renew_for(id, seconds(1));
  world.controller().end_jog(id, {}, world.now());
  EXPECT_EQ(outcome(id).state, MotionState::succeeded);
  EXPECT_LT(world.device().position(1), -900);
  EXPECT_GT(world.device().position(3), 900);
  EXPECT_EQ(written(world, "J:B-+"), 1);
}

class HazardOfJogsAt : public HazardOfJogs, public testing::WithParamInterface<int> {
 protected:
  HazardOfJogsAt() : HazardOfJogs(at_baud(GetParam())) {}
};

// The stop comes after 500 ms and two cycles of the line: the longest exchange that may be ahead of the stop, and the
// stop itself.
TEST_P(HazardOfJogsAt, H29_SilenceStopsIt) {
  const MotionId id = jog({{1, 1, pulses(20'000)}});
  renew_for(id, seconds(2));
  EXPECT_TRUE(world.device().busy(1));
  const TimePoint last = renewed;
  ASSERT_TRUE(world.run_until([&] { return written(world, "L:") > 0; }, seconds(5))) << world.replay();
  const Duration line_cycle = Duration(seconds(10 * 64)) / GetParam();
  EXPECT_GE(world.now() - last, Controller::kJogSilence) << world.replay();
  EXPECT_LE(world.now() - last, Controller::kJogSilence + 2 * line_cycle) << world.replay();
  const Motion motion = outcome(id);
  EXPECT_EQ(motion.state, MotionState::stopped);
  EXPECT_THAT(motion.problem->message, HasSubstr("was silent for 500 ms"));
  EXPECT_FALSE(world.device().busy(1));
}

INSTANTIATE_TEST_SUITE_P(Baud, HazardOfJogsAt, testing::Values(9600, 38400));

// The caller falls silent before the jog has started: the jog never starts.
TEST_F(HazardOfJogs, H29_SilenceWhileItWaits) {
  move_by(world, {{1, 100'000}});
  world.run_for(milliseconds(100));
  const MotionId id = jog({{1, 1, {}}});
  EXPECT_EQ(outcome(id).state, MotionState::stopped) << world.replay();
  outcome_of(world, 2);
  EXPECT_EQ(written(world, "J:"), 0);
  EXPECT_EQ(world.device().position(1), 100'000);
}

// The stop command is lost: the jog is stopped again.
TEST_F(HazardOfJogs, H29_ALostStopIsSentAgain) {
  const MotionId id = jog({{1, 1, {}}});
  renew_for(id, seconds(1));
  world.wire().set_script(drop_first(world, LineKind::command, "L:"));
  EXPECT_EQ(outcome(id, seconds(10)).state, MotionState::stopped) << world.replay();
  EXPECT_FALSE(world.device().busy(1)) << world.replay();
  EXPECT_GE(written(world, "L:"), 2);
}

TEST_F(HazardOfJogs, ASpeedIsChangedOnTheWayAndTheOldOneComesBack) {
  const MotionId id = jog({{1, 1, pulses(5'000)}});
  renew_for(id, seconds(1));
  EXPECT_EQ(written(world, "JD:1F5000"), 1) << world.replay();
  EXPECT_TRUE(world.controller().renew_jog(id, {{1, 1, pulses(2'000)}}, world.now()));
  renew_for(id, seconds(1));
  EXPECT_EQ(written(world, "JD:1F2000"), 1);
  // 5000 pulses/s for a second and 2000 for another, apart from the ramps and the lines.
  EXPECT_NEAR(static_cast<double>(world.device().position(1)), 7000, 400);
  world.controller().end_jog(id, {}, world.now());
  outcome(id);
  world.run_for(seconds(1));
  EXPECT_EQ(execute(world, {"?:D1"}), std::vector<std::string>{"S1000F50000R100"}) << world.replay();
}

// 93) does not say which F applies after the jog: that of D: or that of JD:.
TEST(HazardOfJogsEnd, H28_TheSpeedAfterwardsUnderBothReadings) {
  for (const char* reading : {"becomes_maximum", "forgotten"}) {
    auto setup = quiet();
    ASSERT_TRUE(setup.options.set("jog_override_afterwards", reading));
    World world(setup);
    ASSERT_TRUE(world.run_until_up());
    const MotionId id = world.controller().jog({{{1, 1, pulses(5'000)}}, world.context("anna")}, world.now(),
                                               [](const Result<Motion>&) {});
    world.run_for(seconds(3));
    EXPECT_TRUE(is_outcome(world.controller().find_motion(id)->state));
    EXPECT_EQ(execute(world, {"?:D1"}), std::vector<std::string>{"S1000F50000R100"}) << reading << world.replay();
  }
}

class HazardOfBoundedJogs : public HazardOfJogs {
 protected:
  static simulation::Setup bounded() {
    auto setup = quiet();
    setup.profile.axes[0].travel_minimum = pulses(-20'000);
    setup.profile.axes[0].travel_maximum = pulses(20'000);
    setup.profile.axes[0].maximum_speed = pulses(10'000);
    setup.profile.axes[1].maximum_speed = pulses(500);  // S is 1000
    return setup;
  }
  HazardOfBoundedJogs() : HazardOfJogs(bounded()) {}
};

TEST_F(HazardOfBoundedJogs, EndsBeforeTheTravelLimit) {
  for (const int direction : {1, -1}) {
    const MotionId id = jog({{1, direction, pulses(10'000)}});
    renew_for(id, seconds(8));
    const Motion motion = outcome(id);
    EXPECT_EQ(motion.state, MotionState::stopped) << world.replay();
    EXPECT_EQ(reason_of(motion), Reason::outside_travel);
    EXPECT_LE(std::abs(world.device().position(1)), 20'000) << world.replay();
    // Not much before the limit, either: the distance of 0.6 s and of the deceleration.
    EXPECT_GE(std::abs(world.device().position(1)), 20'000 - 6'200 - 2'500) << world.replay();
  }
}

class HazardOfBoundedJogsWhen : public HazardOfBoundedJogs, public testing::WithParamInterface<int> {};

// An answer is lost near the limit, so that the stop waits for the longest possible time.
TEST_P(HazardOfBoundedJogsWhen, AnAnswerIsLost) {
  const MotionId id = jog({{1, 1, pulses(10'000)}});
  renew_for(id, milliseconds(GetParam()));
  world.wire().set_script(drop_first(world, LineKind::reply, "Q:S"));
  renew_for(id, seconds(3));
  EXPECT_EQ(reason_of(outcome(id)), Reason::outside_travel) << world.replay();
  EXPECT_LE(world.device().position(1), 20'000) << world.replay();
}

INSTANTIATE_TEST_SUITE_P(Milliseconds, HazardOfBoundedJogsWhen, testing::Range(900, 1500, 50));

// Near the limit the axis accelerates only as far as the remaining distance allows, and so gets nearer to the limit.
TEST_F(HazardOfBoundedJogs, ASpeedThatTheWayDoesNotAllow) {
  moved(world, {{1, 17'400}});
  const MotionId id = jog({{1, 1, pulses(8'000)}});
  renew_for(id, seconds(3));
  EXPECT_EQ(reason_of(outcome(id)), Reason::outside_travel) << world.replay();
  EXPECT_LE(world.device().position(1), 20'000) << world.replay();
  EXPECT_EQ(written(world, "JD:1F2000"), 1) << world.replay();
}

// The answer to the start is lost: an axis that may run is still stopped before the limit.
TEST_F(HazardOfBoundedJogs, AStartInDoubt) {
  moved(world, {{1, 19'000}});
  world.wire().set_script(drop_first(world, LineKind::reply, "G:1"));
  const MotionId id = jog({{1, 1, {}}});
  renew_for(id, seconds(4));
  EXPECT_TRUE(is_outcome(outcome(id).state)) << world.replay();
  EXPECT_FALSE(world.device().busy(1));
  EXPECT_GT(world.device().position(1), 19'000) << world.replay();
  EXPECT_LE(world.device().position(1), 20'000) << world.replay();
}

TEST_F(HazardOfBoundedJogs, TooNearToTheLimitItDoesNotStart) {
  moved(world, {{1, 19'900}});
  const MotionId id = jog({{1, 1, {}}});
  const Motion motion = outcome(id);
  EXPECT_EQ(motion.state, MotionState::failed);
  EXPECT_EQ(reason_of(motion), Reason::outside_travel);
  EXPECT_EQ(written(world, "J:"), 0);
  const MotionId back = jog({{1, -1, {}}});
  renew_for(back, seconds(1));
  EXPECT_LT(world.device().position(1), 19'900);
}

TEST_F(HazardOfBoundedJogs, TooFastIsRefusedAndASlowAxisStartsSlowly) {
  EXPECT_EQ(jog({{1, 1, pulses(10'001)}}), 0u);
  EXPECT_EQ(refused, Reason::too_fast);
  const MotionId id = jog({{2, 1, {}}});
  renew_for(id, seconds(2));
  EXPECT_NEAR(static_cast<double>(world.device().position(2)), 1000, 100) << world.replay();
  const Result<void> faster = world.controller().renew_jog(id, {{2, 1, pulses(501)}}, world.now());
  ASSERT_FALSE(faster);
  EXPECT_EQ(faster.error().reason, Reason::too_fast);
  world.controller().end_jog(id, {}, world.now());
  outcome(id);
  world.run_for(seconds(1));
  EXPECT_EQ(execute(world, {"?:D2"}), std::vector<std::string>{"S1000F50000R100"}) << world.replay();
}

// No stop can be sent while the line is lost. The jog is stopped as soon as the line is back.
TEST_F(HazardOfJogs, H31_TheLineIsLostUnderIt) {
  const MotionId id = jog({{1, 1, {}}});
  renew_for(id, seconds(1));
  world.wire().cut(world.now(), seconds(2));
  renew_for(id, seconds(1));
  EXPECT_EQ(outcome(id).state, MotionState::unknown) << world.replay();
  EXPECT_TRUE(world.device().busy(1));
  ASSERT_TRUE(world.run_until([&] { return !world.device().busy(1); }, seconds(10))) << world.replay();
  ASSERT_TRUE(world.run_until_up()) << world.replay();
}

// The stop at the line's return is lost: the jog is stopped again.
TEST_F(HazardOfJogs, H31_TheStopAtTheLinesReturnIsLost) {
  const MotionId id = jog({{1, 1, {}}});
  renew_for(id, seconds(1));
  world.wire().set_script(drop_first(world, LineKind::command, "L:"));
  world.wire().cut(world.now(), seconds(2));
  renew_for(id, seconds(1));
  ASSERT_TRUE(world.run_until([&] { return !world.device().busy(1); }, seconds(20))) << world.replay();
  ASSERT_TRUE(world.run_until_up()) << world.replay();
}

// NG to the start may answer another line: an axis that still runs is stopped.
TEST_F(HazardOfJogs, H03_ARefusedStartThatWasNone) {
  world.wire().set_script([this](LineKind kind, const std::string&) {
    const bool answer = kind == LineKind::reply && world.wire().commands().back() == "G:1";
    return answer ? Scripted{.drop = false, .delay = {}, .instead = "NG\r\n"} : Scripted{};
  });
  const MotionId id = jog({{1, 1, {}}});
  renew_for(id, seconds(2));
  world.controller().end_jog(id, {}, world.now());
  EXPECT_TRUE(is_outcome(outcome(id).state)) << world.replay();
  world.run_for(seconds(1));
  EXPECT_FALSE(world.device().busy(1)) << world.replay();
}

TEST_F(HazardOfJogs, AnothersStopStopsIt) {
  const MotionId id = jog({{1, 1, {}}});
  renew_for(id, seconds(1));
  world.controller().stop({}, world.context("bert"), world.now(), [](const StopReport&) {});
  renew_for(id, seconds(1));
  const Motion motion = outcome(id);
  EXPECT_EQ(motion.state, MotionState::stopped);
  EXPECT_THAT(motion.problem->message, HasSubstr("bert"));
}

// A stop of one axis ends the jog of all axes, because axes that were requested together run together.
TEST_F(HazardOfJogs, AStopOfOneAxisStopsAll) {
  const MotionId id = jog({{1, -1, {}}, {3, 1, {}}});
  renew_for(id, seconds(1));
  world.controller().stop(AxisSet::of(3), world.context("bert"), world.now(), [](const StopReport&) {});
  renew_for(id, seconds(1));
  EXPECT_FALSE(world.device().busy(1)) << world.replay();
  EXPECT_EQ(outcome(id).state, MotionState::stopped);
  EXPECT_THAT(outcome(id).problem->message, HasSubstr("bert"));
}

// A stop between set and go: the jog is not started, and its setting does not run with another caller's start.
TEST(HazardOfJogsEnd, H12_AJogThatWasSetAndNotStarted) {
  for (const char* reading : {"yes", "no"}) {
    auto setup = quiet();
    ASSERT_TRUE(setup.options.set("jog_survives_gc", reading));
    World world(setup);
    ASSERT_TRUE(world.run_until_up());
    (void)world.controller().jog({{{1, 1, {}}}, world.context("anna")}, world.now(), [](const Result<Motion>&) {});
    ASSERT_TRUE(world.run_until([&] { return world.wire().commands().back().starts_with("J:"); }, seconds(5)));
    EXPECT_FALSE(stopped(world).problem) << world.replay();
    EXPECT_EQ(written(world, "G:"), 0);
    move_by(world, {{1, 500}});
    const Motion motion = outcome_of(world, 2);
    const bool survives = std::string_view(reading) == "yes";
    EXPECT_EQ(motion.state, survives ? MotionState::failed : MotionState::succeeded) << world.replay();
    EXPECT_EQ(reason_of(motion), survives ? Reason::stale_setpoint : Reason::unspecified);
    EXPECT_EQ(world.device().position(1), survives ? 0 : 500) << world.replay();
  }
}

TEST(HazardOfJogsEnd, H35_ItEndsWithTheLease) {
  server::LeaseTokens tokens{1};
  server::Leases leases{tokens};
  auto setup = quiet();
  setup.permission = &leases;
  World world(setup);
  ASSERT_TRUE(world.run_until_up());
  server::LeaseToken token = 0;
  leases.acquire({.scope = AxisSet::of(1), .time_to_live = seconds(3), .at_loss = server::AtLoss::finish}, "anna",
                 false, world.now(), world.now(),
                 [&](const Result<server::Lease>& got) { token = got ? got->token : 0; });
  RequestContext context = world.context("anna");
  context.lease = token;
  const MotionId id = world.controller().jog({{{1, 1, {}}}, context}, world.now(), [](const Result<Motion>&) {});
  for (int i = 0; i < 50; ++i) {
    (void)world.controller().renew_jog(id, {}, world.now());
    world.run_for(kRenewal);
  }
  EXPECT_FALSE(world.device().busy(1)) << world.replay();
  EXPECT_EQ(reason_of(*world.controller().find_motion(id)), Reason::lease_lost) << world.replay();
}

// A gateway that waits for motions to finish does not wait for a jog, which never finishes.
TEST(HazardOfJogsEnd, TheGatewayEnds) {
  auto setup = quiet();
  setup.profile.at_exit = AtExit::finish;
  World world(setup);
  ASSERT_TRUE(world.run_until_up());
  const MotionId id =
      world.controller().jog({{{1, 1, {}}}, world.context("anna")}, world.now(), [](const Result<Motion>&) {});
  world.run_for(milliseconds(400));
  bool ended = false;
  world.controller().wind_down(world.now(), [&](const WindDownReport&) { ended = true; });
  for (int i = 0; i < 20 && !ended; ++i) {
    (void)world.controller().renew_jog(id, {}, world.now());
    world.run_for(kRenewal);
  }
  EXPECT_TRUE(ended) << world.replay();
  EXPECT_FALSE(world.device().busy(1));
}

// Execute refuses J: and JD:, because no watchdog would stop an axis that they start.
TEST_F(HazardOfJogs, ExecuteDoesNotJog) {
  EXPECT_EQ(execute(world, {"J:1+", "G:1"}), std::vector<std::string>{"INVALID_REQUEST"});
  EXPECT_EQ(execute(world, {"JD:1F100"}), std::vector<std::string>{"INVALID_REQUEST"});
  EXPECT_EQ(written(world, "J"), 0);
}

}  // namespace
}  // namespace axisgate::simulation
