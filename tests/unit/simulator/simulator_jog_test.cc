// Jogging of a simulated axis (manual 88) J:), and the changes that JD: makes during a jog (manual 93)).
#include <gtest/gtest.h>

#include "device/shrc203/simulator/motion/motion_profile.h"
#include "tests/unit/simulator/simulator_bench.h"

namespace axisgate::shrc203::simulator::simulator_jog_test {
namespace {

using namespace std::chrono_literals;

constexpr Duration kSettlingTime = 5ms;

// S 1000, F 11000, R 100 ms on every axis: each ramp has a slope of 100000 pulses/s^2.
class Bench : public SimulatorBench {
 public:
  explicit Bench(const Settings& settings = {}, Options options = {}) : SimulatorBench(settings, std::move(options)) {
    ask("D:WS1000F11000R100 S1000F11000R100 S1000F11000R100");
  }

  void start_jog(const std::string& axes, const std::string& directions) {
    EXPECT_EQ(ask("J:" + axes + directions), "OK");
    EXPECT_EQ(ask("G:" + axes), "OK");
  }
};

TEST(MotionProfile, ChangesUpAndDownAndGoesOn) {
  // 1000 to 6000 takes 50 ms and (1000 + 6000) / 2 * 0.05 = 175 pulses; the other 6000 take one second more.
  const auto up = MotionProfile::changing(6175, 1000, 6000, {1000, 11000, 100});
  EXPECT_EQ(up.duration(), 1050ms);
  EXPECT_NEAR(up.speed_at(25ms), 3500, 1e-6);
  EXPECT_NEAR(up.distance_at(50ms), 175, 1e-6);
  EXPECT_NEAR(up.distance_at(550ms), 3175, 1e-6);
  // 6000 to 1000 is the same ramp; the other 1000 take one second.
  const auto down = MotionProfile::changing(1175, 6000, 1000, {1000, 11000, 100});
  EXPECT_EQ(down.duration(), 1050ms);
  EXPECT_NEAR(down.speed_at(25ms), 3500, 1e-6);
  EXPECT_NEAR(down.distance_at(50ms), 175, 1e-6);
  EXPECT_NEAR(down.distance_at(550ms), 675, 1e-6);
}

TEST(MotionProfile, AChangeMayEndInItsRamp) {
  // 30 ms up: 1000 * 0.03 + 100000 / 2 * 0.03^2 = 75. From 4000 down, 20 ms: 4000 * 0.02 - 100000 / 2 * 0.02^2 = 60.
  EXPECT_EQ(MotionProfile::changing(75, 1000, 6000, {1000, 11000, 100}).duration(), 30ms);
  EXPECT_EQ(MotionProfile::changing(60, 4000, 1000, {1000, 11000, 100}).duration(), 20ms);
}

TEST(SimulatorJog, IsSetByJAndStartedByG) {
  Bench bench;
  EXPECT_EQ(bench.ask("?:J"), "NS,NS,NS");
  ASSERT_EQ(bench.ask("J:A+-"), "OK");
  EXPECT_EQ(bench.ask("?:J"), "+,-,NS");
  EXPECT_EQ(bench.wait(1s), "");
  EXPECT_EQ(bench.ask("Q:"), "+        0,+        0,+        0,K,K,R");
  ASSERT_EQ(bench.ask("G:A"), "OK");
  EXPECT_EQ(bench.ask("?:J"), "+,-,NS");
  EXPECT_EQ(bench.ask("!:S"), "B,B,R");
  bench.wait(1500ms);
  EXPECT_EQ(bench.ask("Q:"), "+     1500,-     1500,+        0,K,K,B");
  EXPECT_EQ(bench.device.starts(1), 1);
}

TEST(SimulatorJog, TakesTheManualsDirections) {
  for (const auto& [line, directions] : Settings{{"J:1+", "+,NS,NS"},
                                                 {"J:A+-", "+,-,NS"},
                                                 {"J:B++", "+,NS,+"},
                                                 {"J:C--", "NS,-,-"},
                                                 {"J:D+-+", "+,-,+"},
                                                 {"J:W+++", "+,+,+"},
                                                 {"J:2", "NS,+,NS"}}) {  // "If there is no sign, it will be +"
    Bench bench;
    EXPECT_EQ(bench.ask(line), "OK") << line;
    EXPECT_EQ(bench.ask("?:J"), directions) << line;
  }
}

TEST(SimulatorJog, IsRefusedWhenBusyOrWithoutExcitation) {
  Bench bench;
  bench.start_jog("1", "+");
  EXPECT_EQ(bench.ask("J:1-"), "NG");
  EXPECT_EQ(bench.ask("J:A--"), "NG");
  EXPECT_EQ(bench.ask("G:1"), "NG");
  bench.ask("C:20");
  EXPECT_EQ(bench.ask("J:2+"), "NG");
  for (const auto* line : {"J:", "J:+", "J:3+P1", "J:3+-", "J:4+"}) EXPECT_EQ(bench.ask(line), "NG") << line;
}

TEST(SimulatorJog, RunsUntilStoppedAndTellsNoCompletion) {
  Bench bench(Settings{{"completion_after_stop", "sent"}});
  bench.start_jog("1", "-");
  EXPECT_EQ(bench.wait(1000s), "");
  EXPECT_EQ(bench.ask("!:"), "B");
  ASSERT_EQ(bench.ask("L:1"), "OK");  // no faster than S, so it stops at once
  EXPECT_EQ(bench.rest(), "");
  EXPECT_EQ(bench.elapsed(), 1000s + kSettlingTime);
  EXPECT_EQ(bench.ask("Q:"), "-  1000000,+        0,+        0,K,K,R");
  EXPECT_EQ(bench.ask("?:J"), "NS,NS,NS");
  EXPECT_EQ(bench.ask("G:1"), "NG");
}

TEST(SimulatorJog, AnOverrideRampsUpAndDown) {
  Bench bench;
  bench.start_jog("1", "+");
  bench.wait(1s);
  ASSERT_EQ(bench.ask("JD:1F6000"), "OK");
  EXPECT_EQ(bench.device.position(1), 1000);
  bench.wait(25ms);  // up to 3500: (1000 + 3500) / 2 * 0.025 = 56.25
  EXPECT_EQ(bench.device.position(1), 1056);
  bench.wait(25ms);  // up to 6000: (1000 + 6000) / 2 * 0.05 = 175
  EXPECT_EQ(bench.device.position(1), 1175);
  bench.wait(1s);
  EXPECT_EQ(bench.device.position(1), 7175);
  ASSERT_EQ(bench.ask("JD:1F2000"), "OK");
  bench.wait(20ms);  // down to 4000: (6000 + 4000) / 2 * 0.02 = 100
  EXPECT_EQ(bench.device.position(1), 7275);
  bench.wait(20ms);  // down to 2000: (6000 + 2000) / 2 * 0.04 = 160
  EXPECT_EQ(bench.device.position(1), 7335);
  bench.wait(1s);
  EXPECT_EQ(bench.device.position(1), 9335);
  EXPECT_EQ(bench.ask("!:1S"), "B");
  EXPECT_EQ(bench.device.starts(1), 1);
}

TEST(SimulatorJog, AnOverrideInTheMidstOfARampTurnsItRound) {
  Bench bench;
  bench.start_jog("1", "-");
  ASSERT_EQ(bench.ask("JD:1F11000"), "OK");
  bench.wait(40ms);  // up to 5000: (1000 + 5000) / 2 * 0.04 = 120
  EXPECT_EQ(bench.device.position(1), -120);
  ASSERT_EQ(bench.ask("JD:1F3000"), "OK");
  bench.wait(20ms);  // down to 3000: (5000 + 3000) / 2 * 0.02 = 80
  EXPECT_EQ(bench.device.position(1), -200);
  bench.wait(100ms);
  EXPECT_EQ(bench.device.position(1), -500);
}

TEST(SimulatorJog, MayBeSlowerThanS) {
  Bench bench;
  bench.start_jog("1", "+");
  ASSERT_EQ(bench.ask("JD:1F600"), "OK");
  bench.wait(4ms);  // down to 600: (1000 + 600) / 2 * 0.004 = 3.2
  EXPECT_EQ(bench.device.position(1), 3);
  bench.wait(1s);  // 603.2
  EXPECT_EQ(bench.device.position(1), 603);
  ASSERT_EQ(bench.ask("L:1"), "OK");
  bench.rest();
  EXPECT_EQ(bench.elapsed(), 1004ms + kSettlingTime);
  EXPECT_EQ(bench.device.position(1), 603);
  EXPECT_EQ(bench.ask("?:D1"), "S1000F1000R100");  // F is not lower than S
}

// Every 2 ms are 0.333 + 0.667 pulses, which would be lost if each change began at a whole pulse.
TEST(SimulatorJog, LosesNoPulseHoweverOftenItChanges) {
  SimulatorBench bench;
  bench.ask("D:1S1000F1000R100");  // no ramps
  bench.ask("J:1+");
  bench.ask("G:1");
  for (int i = 0; i < 1000; ++i) {
    ASSERT_EQ(bench.ask("JD:1F333"), "OK");
    bench.wait(1ms);
    ASSERT_EQ(bench.device.position(1), i);
    ASSERT_EQ(bench.ask("JD:1F667"), "OK");
    bench.wait(1ms);
    ASSERT_EQ(bench.device.position(1), i + 1);
  }
}

// The same speed is requested repeatedly at odd times, during its ramp and after it.
TEST(SimulatorJog, IsWhereAnUndisturbedOneIs) {
  Bench disturbed, undisturbed;
  for (Bench* bench : {&disturbed, &undisturbed}) {
    bench->start_jog("1", "-");
    bench->ask("JD:1F6000");
  }
  for (int i = 0; i < 1000; ++i) {
    disturbed.wait(137us);
    undisturbed.wait(137us);
    ASSERT_EQ(disturbed.ask("JD:1F6000"), "OK");
    ASSERT_EQ(disturbed.device.position(1), undisturbed.device.position(1)) << i;
  }
}

TEST(SimulatorJog, TakesTheManualsOverrides) {
  // 10 nm a pulse: 0.01 mm/s are 1000 pulses/s. Each row is a line and the maximum speeds after it.
  for (const auto& [line, speeds] : Settings{{"JD:1F1000", "1000,11000,11000"},
                                             {"JD:2F2000", "11000,2000,11000"},
                                             {"JD:3F3000", "11000,11000,3000"},
                                             {"JD:AF1000F2000", "1000,2000,11000"},
                                             {"JD:BF1000F3000", "1000,11000,3000"},
                                             {"JD:CF2000F3000", "11000,2000,3000"},
                                             {"JD:DF1000F2000F3000", "1000,2000,3000"},
                                             {"JD:WM0.01M0.02M0.03", "1000,2000,3000"},
                                             {"JD:WN20000U30D0.04", "2000,3000,4000"},
                                             {"JD:1F1000000", "1000000,11000,11000"}}) {
    Bench bench;
    bench.start_jog("W", "+-+");
    EXPECT_EQ(bench.ask(line), "OK") << line;
    bench.ask("L:W");
    EXPECT_EQ(bench.rest(), "") << line;
    EXPECT_EQ(bench.ask("?:DF"), speeds) << line;
  }
}

TEST(SimulatorJog, EachAxisHasAnOverrideOfItsOwn) {
  Bench bench;
  bench.start_jog("B", "+-");
  ASSERT_EQ(bench.ask("JD:BF6000F2000"), "OK");
  bench.wait(1050ms);
  // Axis 1: 175 in 50 ms, and 6000. Axis 3: (1000 + 2000) / 2 * 0.01 = 15 in 10 ms, and 2000 * 1.04.
  EXPECT_EQ(bench.ask("Q:"), "+     6175,+        0,-     2095,K,K,B");
}

TEST(SimulatorJog, AnOverrideOutOfRangeIsRefusedAsAWhole) {
  Bench bench;
  bench.start_jog("A", "++");
  for (const auto* line : {"JD:1F0", "JD:1F1000001", "JD:1N0", "JD:1M10.00001", "JD:1P1000", "JD:1F-1000", "JD:1F",
                           "JD:1", "JD:", "JD:F1000", "JD:1F1000F2000", "JD:AF2000", "JD:AF2000F0", "JD:4F1000"}) {
    EXPECT_EQ(bench.ask(line), "NG") << line;
  }
  bench.wait(1s);
  EXPECT_EQ(bench.ask("Q:"), "+     1000,+     1000,+        0,X,K,B");
}

TEST(SimulatorJog, AnOverrideIsRefusedUnlessEveryAxisJogs) {
  Bench bench;
  EXPECT_EQ(bench.ask("JD:1F2000"), "NG");
  bench.ask("J:1+");
  EXPECT_EQ(bench.ask("JD:1F2000"), "NG");  // set, but not started
  bench.ask("G:1");
  bench.ask("M:2+P100000");
  bench.ask("G:2");
  EXPECT_EQ(bench.ask("JD:2F2000"), "NG");  // moves, but not by J:
  EXPECT_EQ(bench.ask("JD:AF2000F2000"), "NG");
  EXPECT_EQ(bench.ask("JD:WF2000F2000F2000"), "NG");
  bench.wait(1s);
  EXPECT_EQ(bench.device.position(1), 1000);
  EXPECT_EQ(bench.ask("JD:1F2000"), "OK");
}

TEST(SimulatorJog, AStopDeceleratesAndCannotBeOverridden) {
  Bench bench;
  bench.start_jog("1", "+");
  bench.ask("JD:1F6000");
  bench.wait(50ms);
  ASSERT_EQ(bench.device.position(1), 175);
  ASSERT_EQ(bench.ask("L:1"), "OK");
  EXPECT_EQ(bench.ask("JD:1F6000"), "NG");
  bench.wait(50ms);  // 6000 down to 1000, then stationary: 175
  EXPECT_EQ(bench.device.position(1), 350);
  EXPECT_EQ(bench.ask("!:1S"), "B");
  EXPECT_EQ(bench.ask("JD:1F6000"), "NG");
  EXPECT_EQ(bench.rest(), "");
  EXPECT_EQ(bench.elapsed(), 100ms + kSettlingTime);
  EXPECT_EQ(bench.device.position(1), 350);
  EXPECT_EQ(bench.ask("JD:1F6000"), "NG");
}

TEST(SimulatorJog, AStopInTheMidstOfARampTurnsItRound) {
  Bench bench;
  bench.start_jog("1", "-");
  bench.ask("JD:1F7000");
  bench.wait(40ms);  // up to 5000: (1000 + 5000) / 2 * 0.04 = 120
  ASSERT_EQ(bench.device.position(1), -120);
  ASSERT_EQ(bench.ask("L:"), "OK");
  bench.rest();  // the same ramp down again
  EXPECT_EQ(bench.elapsed(), 80ms + kSettlingTime);
  EXPECT_EQ(bench.device.position(1), -240);
}

TEST(SimulatorJog, AnEmergencyStopEndsItAtOnce) {
  Bench bench(Settings{{"emergency_excitation", "on"}});
  bench.start_jog("1", "+");
  bench.ask("JD:1F6000");
  bench.wait(50ms);
  ASSERT_EQ(bench.ask("L:E"), "OK");
  EXPECT_EQ(bench.rest(), "");
  EXPECT_EQ(bench.device.position(1), 175);
  EXPECT_EQ(bench.ask("JD:1F2000"), "NG");
  EXPECT_EQ(bench.ask("?:D1"), "S1000F6000R100");
}

TEST(SimulatorJog, ALimitSensorStopsAnOverriddenOne) {
  Options options;
  options.axes[0].travel_plus_pulses = 1000;
  Bench bench({}, options);
  bench.start_jog("1", "+");
  bench.wait(500ms);
  bench.ask("JD:1F6000");
  // 500, then 175 in 50 ms, then 325 at 6000 pulses/s: 54.1666... ms.
  EXPECT_EQ(bench.rest(), "");
  EXPECT_EQ(bench.elapsed(), 604166667ns + kSettlingTime);
  EXPECT_EQ(bench.ask("Q:"), "+     1000,+        0,+        0,K,1,R");
  EXPECT_EQ(bench.ask("?:D1"), "S1000F6000R100");
}

// Manual 93): "At the end of the "J:" command operation, the maximum speed set by the "D:" command is overwritten."
TEST(SimulatorJog, OverridesAfterwards) {
  for (const auto& [value, speed] : Settings{{"becomes_maximum", "S1000F6000R100"}, {"forgotten", "S1000F11000R100"}}) {
    Bench bench(Settings{{"jog_override_afterwards", value}});
    bench.start_jog("A", "++");
    bench.ask("JD:1F2000");
    bench.ask("JD:1F6000");
    bench.wait(50ms);
    EXPECT_EQ(bench.ask("?:D1"), "S1000F11000R100") << value;
    bench.ask("L:A");
    bench.rest();
    EXPECT_EQ(bench.ask("?:D1"), speed) << value;
    EXPECT_EQ(bench.ask("?:D2"), "S1000F11000R100") << value;
    // The next jog begins at S again.
    const auto before = bench.device.position(1);
    bench.start_jog("1", "+");
    bench.wait(1s);
    EXPECT_EQ(bench.device.position(1), before + 1000) << value;
  }
}

}  // namespace
}  // namespace axisgate::shrc203::simulator::simulator_jog_test
