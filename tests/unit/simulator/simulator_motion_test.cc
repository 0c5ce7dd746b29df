// Motion of simulated axes: profiles, ends, limits, origin, stops.
#include <gtest/gtest.h>

#include "device/shrc203/simulator/motion/motion_profile.h"
#include "tests/unit/simulator/simulator_bench.h"

namespace axisgate::shrc203::simulator::simulator_motion_test {
namespace {

using namespace std::chrono_literals;

constexpr Duration kSettles = 5ms;

TEST(MotionProfile, RampsUpRunsAndRampsDown) {
  // S 1000, F 11000, R 100 ms: 600 pulses in each ramp. 600 + 11000 + 600 pulses: 0.1 + 1 + 0.1 s.
  const auto profile = MotionProfile::trapezoid(12200, {1000, 11000, 100});
  EXPECT_EQ(profile.duration(), 1200ms);
  EXPECT_DOUBLE_EQ(profile.distance_at(0ms), 0);
  EXPECT_NEAR(profile.distance_at(50ms), 175, 1e-6);
  EXPECT_NEAR(profile.distance_at(100ms), 600, 1e-6);
  EXPECT_NEAR(profile.distance_at(600ms), 6100, 1e-6);
  EXPECT_NEAR(profile.distance_at(1150ms), 12200 - 175, 1e-6);
  EXPECT_DOUBLE_EQ(profile.distance_at(1200ms), 12200);
  EXPECT_NEAR(profile.speed_at(50ms), 6000, 1e-6);
  EXPECT_NEAR(profile.speed_at(500ms), 11000, 1e-6);
}

TEST(MotionProfile, ShortPathTurnsRoundBelowTheMaximum) {
  // Slope 100000 pulses/s^2 from 1000 pulses/s: 50 ms up to 6000 pulses/s cover 175 pulses.
  const auto profile = MotionProfile::trapezoid(350, {1000, 11000, 100});
  EXPECT_NEAR(static_cast<double>(profile.duration().count()), 100e6, 10);
  EXPECT_NEAR(profile.speed_at(50ms), 6000, 1);
  EXPECT_NEAR(profile.distance_at(50ms), 175, 1e-3);
}

TEST(MotionProfile, KnowsWhenItIsWhere) {
  const auto profile = MotionProfile::trapezoid(12200, {1000, 11000, 100});
  for (const double distance : {1.0, 175.0, 600.0, 6100.0, 12000.0}) {
    EXPECT_NEAR(profile.distance_at(profile.time_at(distance)), distance, 1e-3) << distance;
  }
}

TEST(MotionProfile, EqualSpeedsNeedNoRamp) {
  EXPECT_EQ(MotionProfile::trapezoid(1000, {1000, 1000, 100}).duration(), 1s);
  EXPECT_EQ(MotionProfile::slowing(1000, {1000, 1000, 100}).duration(), 0s);
}

TEST(SimulatorMotion, MovesAsTheSpeedsSayAndSettles) {
  SimulatorBench bench;
  bench.ask("D:1S1000F11000R100");
  bench.ask("M:1+P12200");
  ASSERT_EQ(bench.ask("G:1"), "OK");
  EXPECT_EQ(bench.ask("?:M1"), "12200");
  bench.wait(100ms);
  EXPECT_EQ(bench.device.position(1), 600);
  bench.wait(1100ms);
  EXPECT_EQ(bench.device.position(1), 12200);
  EXPECT_EQ(bench.ask("!:1S"), "B");
  EXPECT_EQ(bench.device.next_deadline(), bench.now() + kSettles);
  bench.wait(kSettles);
  EXPECT_EQ(bench.ask("!:1S"), "R");
  EXPECT_EQ(bench.device.next_deadline(), std::nullopt);
  EXPECT_EQ(bench.ask("?:M1"), "NS");
  EXPECT_EQ(bench.ask("G:1"), "NG");
}

// Manual 56): W: sets the time from the end of positioning to READY.
TEST(SimulatorMotion, WaitsBeforeReadyAsWSays) {
  SimulatorBench bench;
  bench.ask("W:3");
  bench.ask("D:1S1000F1000R1");
  bench.ask("M:1+P1000");
  bench.ask("G:1");
  bench.rest();
  EXPECT_EQ(bench.elapsed(), 1s + kSettles + 300ms);
}

TEST(SimulatorMotion, AxesMoveIndependently) {
  SimulatorBench bench;
  bench.ask("D:AS1000F1000R1 S1000F1000R1");
  bench.ask("M:A+P1000-P2000");
  bench.ask("G:A");
  bench.wait(500ms);
  EXPECT_EQ(bench.device.position(1), 500);
  EXPECT_EQ(bench.device.position(2), -500);
  bench.wait(600ms);
  EXPECT_EQ(bench.ask("!:S"), "R,B,R");
  bench.rest();
  EXPECT_EQ(bench.device.position(2), -2000);
  EXPECT_EQ(bench.device.starts(1), 1);
  EXPECT_EQ(bench.device.starts(2), 1);
  EXPECT_EQ(bench.device.starts(3), 0);
}

TEST(SimulatorMotion, ALateCallHandlesEverythingAtItsOwnTime) {
  SimulatorBench bench;
  bench.ask("D:1S1000F1000R1");
  bench.ask("MP:1+P1000");
  bench.ask("G:1");
  bench.ask("MP:1+P2000");
  bench.device.advance(bench.now() + 1h);
  EXPECT_EQ(bench.device.position(1), 3000);
  EXPECT_EQ(bench.device.starts(1), 2);
  EXPECT_EQ(bench.said().back().line, "1");
}

TEST(SimulatorMotion, StraightLineRunsAtSOfTheLowerAxis) {
  SimulatorBench bench;
  bench.ask("D:BS500F50000R100 S9000F50000R100");
  ASSERT_EQ(bench.ask("K:B+P3000-P4000"), "OK");
  ASSERT_EQ(bench.ask("G"), "OK");
  bench.wait(5s);  // 5000 pulses at 500 pulses/s take 10 s
  EXPECT_EQ(bench.device.position(1), 1500);
  EXPECT_EQ(bench.device.position(3), -2000);
  bench.rest();
  EXPECT_EQ(bench.elapsed(), 10s + kSettles);
  EXPECT_EQ(bench.device.position(1), 3000);
  EXPECT_EQ(bench.device.position(3), -4000);
}

TEST(SimulatorMotion, KpSpeedReplacesTheLowerAxisSpeed) {
  SimulatorBench bench;
  ASSERT_EQ(bench.ask("KP:A+P3000+P4000 ,S100F1000R200"), "OK");
  EXPECT_EQ(bench.ask("?:DA"), "S1000F50000R100,S1000F50000R100");
  ASSERT_EQ(bench.ask("G:A"), "OK");
  EXPECT_EQ(bench.ask("?:DA"), "S100F1000R200,S1000F50000R100");
  EXPECT_EQ(bench.rest(), "1 2");
  EXPECT_EQ(bench.elapsed(), 50s + kSettles);
}

TEST(SimulatorMotion, AbsoluteAndLogicalReturn) {
  SimulatorBench bench;
  bench.ask("A:A+P5000-P5000");
  bench.ask("G:A");
  bench.rest();
  EXPECT_EQ(bench.device.position(1), 5000);
  ASSERT_EQ(bench.ask("ZRT:A"), "OK");
  EXPECT_EQ(bench.ask("Q:SP").substr(18, 11), "20001,20001");
  EXPECT_EQ(bench.rest(), "1 2");
  EXPECT_EQ(bench.ask("Q:SP"), "P+0,P+0,P+0,1,1,1,R,R,R");
  bench.ask("Z:");
  EXPECT_EQ(bench.rest(), "");
}

TEST(SimulatorMotion, FindsTheMechanicalOrigin) {
  SimulatorBench bench;
  bench.ask("PSET:1+P777");
  bench.ask("R:2");
  ASSERT_EQ(bench.ask("HRT:"), "OK");
  EXPECT_EQ(bench.ask("SRQ:1S"), "40001,B");
  EXPECT_EQ(bench.rest(), "1 2 3");
  EXPECT_LT(bench.elapsed(), 10s);
  EXPECT_EQ(bench.ask("Q:SP"), "P+0,P+0,P+0,1000001,1000001,1000001,R,R,R");
  // From the far end, the origin is at the same place again.
  bench.ask("M:1+P2090000");
  bench.ask("G:1");
  bench.rest();
  const auto before = bench.elapsed();
  ASSERT_EQ(bench.ask("H4:1"), "OK");
  EXPECT_EQ(bench.rest(), "");
  EXPECT_LT(bench.elapsed() - before, 10s);
  EXPECT_EQ(bench.ask("Q:SP"), "P+0,P+0,P+0,1000001,1000001,1000001,R,R,R");
  EXPECT_EQ(bench.device.starts(1), 3);
}

TEST(SimulatorMotion, CompletionsComeInTheOrderTheAxesFinish) {
  SimulatorBench bench;
  bench.ask("M:A+P1000000-P50000");
  bench.ask("G:A");
  bench.rest();
  bench.ask("HRT:A");
  EXPECT_EQ(bench.rest(), "2 1");
}

TEST(SimulatorMotion, StopDecelerates) {
  SimulatorBench bench;
  bench.ask("D:1S1000F11000R100");
  bench.ask("M:1+P100000");
  bench.ask("G:1");
  bench.wait(1100ms);
  ASSERT_EQ(bench.device.position(1), 600 + 11000);
  ASSERT_EQ(bench.ask("L:1"), "OK");
  bench.rest();
  EXPECT_EQ(bench.device.position(1), 600 + 11000 + 600);
  EXPECT_EQ(bench.elapsed(), 1200ms + kSettles);
  EXPECT_EQ(bench.ask("Q:"), "+    12200,+        0,+        0,K,K,R");
}

TEST(SimulatorMotion, StopOfOneAxisStopsItsStraightLine) {
  SimulatorBench bench;
  bench.ask("D:1S500F500R1");
  bench.ask("KP:A+P3000+P4000");
  bench.ask("G:A");
  bench.wait(5s);
  ASSERT_EQ(bench.ask("L:2"), "OK");
  EXPECT_EQ(bench.rest(), "");
  EXPECT_EQ(bench.device.position(1), 1500);
  EXPECT_EQ(bench.device.position(2), 2000);
}

TEST(SimulatorMotion, JogRunsAtSUntilStopped) {
  SimulatorBench bench;
  bench.ask("J:A+-");
  EXPECT_EQ(bench.ask("?:JA"), "+,-");
  ASSERT_EQ(bench.ask("G:A"), "OK");
  bench.wait(2s);
  EXPECT_EQ(bench.device.position(1), 2000);
  EXPECT_EQ(bench.device.position(2), -2000);
  bench.ask("L:1");
  bench.wait(1s);
  EXPECT_EQ(bench.device.position(1), 2000);
  EXPECT_EQ(bench.device.position(2), -3000);
  EXPECT_EQ(bench.ask("?:JA"), "NS,-");
}

TEST(SimulatorMotion, ALimitSensorStopsThere) {
  Options options;
  options.axes[1].travel_plus_pulses = 1000;
  SimulatorBench bench({}, options);
  bench.ask("MP:2+P5000");
  bench.ask("G:2");
  EXPECT_EQ(bench.rest(), "");
  EXPECT_EQ(bench.device.position(2), 1000);
  EXPECT_EQ(bench.ask("Q:"), "+        0,+     1000,+        0,K,2,R");
  EXPECT_EQ(bench.ask("SRQ:2S"), "80080,R");  // bits 8 and 20; bit 1 off
  for (const auto* line : {"K:A+P1+P1", "KP:A+P1+P1", "E:0A0+P1+P2", "EP:0A0+P1+P2"}) {
    EXPECT_EQ(bench.ask(line), "NG") << line;
  }
  EXPECT_EQ(bench.ask("BEC:2"), "OK");
  EXPECT_EQ(bench.ask("SRQ:2S"), "80001,R");
  bench.ask("M:2+P1");
  EXPECT_EQ(bench.ask("G:2"), "OK");
  bench.rest();
  EXPECT_EQ(bench.device.position(2), 1000);
  EXPECT_EQ(bench.ask("SRQ:2S"), "80080,R");
  bench.ask("BEC:2");
  bench.ask("M:2-P10");
  bench.ask("G:2");
  bench.rest();
  EXPECT_EQ(bench.ask("SRQ:2S"), "1,R");
  EXPECT_EQ(bench.device.position(2), 990);
}

TEST(SimulatorMotion, ALimitSensorStopsTheWholeLine) {
  Options options;
  options.axes[1].travel_minus_pulses = -2000;
  SimulatorBench bench({}, options);
  bench.ask("K:A+P3000-P4000");
  bench.ask("G");
  bench.rest();
  EXPECT_EQ(bench.device.position(1), 1500);
  EXPECT_EQ(bench.device.position(2), -2000);
  EXPECT_EQ(bench.ask("SRQ:AS"), "1,100080,R,R");  // bits 8 and 21, on axis 2 alone
}

TEST(SimulatorMotion, LimitStopLettersAreThoseOfTheStatusField) {
  const std::vector<std::pair<std::string, std::string>> cases = {{"A", "C"}, {"B", "D"}, {"C", "E"},
                                                                  {"D", "W"}, {"1", "1"}, {"3", "3"}};
  for (const auto& [axes, letter] : cases) {
    Options options;
    for (auto& axis : options.axes) axis.travel_plus_pulses = 10;
    SimulatorBench bench({}, options);
    const std::string amounts = axes == "D" ? "+P20+P20+P20" : axes < "A" ? "+P20" : "+P20+P20";
    ASSERT_EQ(bench.ask("M:" + axes + amounts), "OK");
    bench.ask("G:" + axes);
    bench.rest();
    EXPECT_EQ(bench.ask("SRQ:"), "K," + letter + ",R");
  }
}

TEST(SimulatorMotion, APersonPushesALimitSensor) {
  SimulatorBench bench;
  bench.ask("J:1-");
  bench.ask("G:1");
  bench.wait(1s);
  bench.device.set_limit(1, 1, true, bench.now());
  EXPECT_TRUE(bench.device.busy(1));
  bench.device.set_limit(1, -1, true, bench.now());
  bench.rest();
  EXPECT_EQ(bench.device.position(1), -1000);
  EXPECT_EQ(bench.ask("SRQ:1S"), "180080,R");
  bench.device.set_limit(1, 1, false, bench.now());
  bench.device.set_limit(1, -1, false, bench.now());
  bench.ask("BEC:");
  EXPECT_EQ(bench.ask("SRQ:1S"), "1,R");
}

TEST(SimulatorMotion, EmergencyStopLatchesUntilCancelled) {
  SimulatorBench bench(Settings{{"emergency_excitation", "on"}});
  bench.ask("D:1S1000F1000R1");
  bench.ask("MP:1+P5000");
  bench.ask("G:1");
  bench.ask("MP:1+P5000");
  bench.wait(1s);
  ASSERT_EQ(bench.ask("L:E"), "OK");
  EXPECT_EQ(bench.device.position(1), 1000);
  EXPECT_EQ(bench.ask("SRQ:"), "K,R,R");
  EXPECT_EQ(bench.ask("SRQ:S"), "20,20,20,R,R,R");
  EXPECT_EQ(bench.ask("?:MP1"), "NS");
  EXPECT_EQ(bench.rest(), "");
  for (const auto* line : {"M:1+P1", "MP:1+P1", "J:1+", "H:1", "Z:1", "G:1"}) EXPECT_EQ(bench.ask(line), "NG") << line;
  ASSERT_EQ(bench.ask("BEC:1"), "OK");
  EXPECT_EQ(bench.ask("SRQ:S"), "1,20,20,R,R,R");
  EXPECT_EQ(bench.ask("M:1+P1"), "OK");
  EXPECT_EQ(bench.ask("M:2+P1"), "NG");
  bench.device.press_emergency(bench.now());
  EXPECT_EQ(bench.ask("SRQ:1S"), "22,R");  // bit 2 is from the NG before
}

// Manual 53): BEC: releases the positioning incomplete state, here the wait of W:.
TEST(SimulatorMotion, BecEndsTheWaitForReady) {
  SimulatorBench bench;
  bench.ask("W:100");
  bench.ask("M:1+P10");
  bench.ask("G:1");
  bench.wait(1s);
  EXPECT_EQ(bench.ask("!:"), "B");
  EXPECT_EQ(bench.ask("BEC:1"), "OK");
  EXPECT_EQ(bench.ask("!:"), "R");
}

TEST(SimulatorMotion, AMotorThatLosesItsExcitationStops) {
  SimulatorBench bench;
  bench.ask("D:1S1000F1000R1");
  bench.ask("MP:1+P5000");
  bench.ask("G:1");
  bench.wait(1s);
  bench.device.set_excitation(1, false, bench.now());
  EXPECT_EQ(bench.rest(), "");
  EXPECT_EQ(bench.device.position(1), 1000);
  EXPECT_EQ(bench.ask("?:C"), "0,1,1");
  bench.device.set_excitation(1, true, bench.now());
  EXPECT_EQ(bench.ask("M:1+P1"), "OK");
}

TEST(SimulatorMotion, ArcsAreDeletedByGc) {
  SimulatorBench bench;
  bench.ask("E:0A0+P1000+P0");
  EXPECT_EQ(bench.ask("GC:"), "OK");
  EXPECT_EQ(bench.ask("?:E"), "NS");
}

TEST(SimulatorMotion, APowerCycleStopsEverythingInItsPlace) {
  SimulatorBench bench;
  bench.ask("J:1+");
  bench.ask("G:1");
  bench.wait(1s);
  bench.device.power_cycle(bench.now());
  EXPECT_EQ(bench.ask("!:"), "");
  EXPECT_EQ(bench.wait(1s), "");
  EXPECT_EQ(bench.ask("Q:"), "+        0,+        0,+        0,K,K,R");
}

}  // namespace
}  // namespace axisgate::shrc203::simulator::simulator_motion_test
