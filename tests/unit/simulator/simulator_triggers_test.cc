// Trigger output of the simulated SHRC-203: T:T, T:P, T:S, T:M, T:E (manual 97) to 101)) and ?:T (manual 42)).
#include <gtest/gtest.h>

#include "tests/unit/simulator/simulator_bench.h"

namespace axisgate::shrc203::simulator::simulator_triggers_test {
namespace {

using namespace std::chrono_literals;

void move(SimulatorBench& bench, std::string_view setting) {
  ASSERT_EQ(bench.ask(setting), "OK");
  ASSERT_EQ(bench.ask("G"), "OK");
  bench.rest();
}

TEST(SimulatorTriggers, TakesTheManualsExamples) {
  SimulatorBench bench;
  EXPECT_EQ(bench.ask("?:T"), "NS");
  EXPECT_EQ(bench.ask("T:T100"), "OK");
  EXPECT_EQ(bench.ask("T:T20"), "OK");
  EXPECT_EQ(bench.ask("?:T"), "1,20");
  EXPECT_EQ(bench.ask("T:P2P5"), "OK");
  EXPECT_EQ(bench.ask("?:T"), "0,2,5");
  EXPECT_EQ(bench.ask("T:P1P1000"), "OK");
  EXPECT_EQ(bench.ask("?:T"), "0,1,1000");
  EXPECT_EQ(bench.ask("T:E1P+2"), "OK");
  EXPECT_EQ(bench.ask("?:T"), "2,1,2");
  EXPECT_EQ(bench.ask("T:E3P-2"), "OK");
  EXPECT_EQ(bench.ask("?:T"), "3,3,-2");
  EXPECT_EQ(bench.ask("T:M"), "OK");
  EXPECT_EQ(bench.ask("?:T"), "3,3,-2");
  EXPECT_EQ(bench.ask("T:S"), "OK");
  EXPECT_EQ(bench.ask("?:T"), "NS");
}

TEST(SimulatorTriggers, RefusesWhatIsOutOfRange) {
  SimulatorBench bench;
  for (const auto* line : {"T:",     "T",      "T:T",    "T:T0",       "T:T10001", "T:T-1",  "T:P1",    "T:P0P5",
                           "T:P4P5", "T:PAP5", "T:P1P1", "T:P1P30001", "T:P1P+5",  "T:E1P2", "T:E1P+1", "T:E1P-30001",
                           "T:E1+2", "T:M1",   "T:S1",   "T:X",        "?:T1",     "T:P1P5X"}) {
    EXPECT_EQ(bench.ask(line), "NG") << line;
  }
  for (const auto* line : {"T:T1", "T:T10000", "T:P1P2", "T:P3P30000", "T:E1P+30000", "T:E1P-2"}) {
    EXPECT_EQ(bench.ask(line), "OK") << line;
  }
}

TEST(SimulatorTriggers, RefusesAnAxisThatItDoesNotControl) {
  Options options;
  options.axis_setting = 3;  // 1st and 2nd
  SimulatorBench bench({}, options);
  EXPECT_EQ(bench.ask("T:P2P5"), "OK");
  EXPECT_EQ(bench.ask("T:P3P5"), "NG");
  EXPECT_EQ(bench.ask("T:E3P+5"), "NG");
}

TEST(SimulatorTriggers, RefusesWhenAnythingIsBusy) {
  SimulatorBench bench;
  bench.ask("J:2+");
  bench.ask("G:2");
  for (const auto* line : {"T:T100", "T:P1P5", "T:S", "T:M", "T:E1P+2"}) EXPECT_EQ(bench.ask(line), "NG") << line;
  EXPECT_EQ(bench.ask("?:T"), "NS");
  EXPECT_EQ(bench.device.trigger_pulses(), 0);
}

TEST(SimulatorTriggers, NeedsNoMotor) {
  SimulatorBench bench;
  bench.ask("C:W0");
  for (const auto* line : {"T:T100", "T:P1P5", "T:S", "T:M", "T:E1P+2"}) EXPECT_EQ(bench.ask(line), "OK") << line;
}

TEST(SimulatorTriggers, OneShotIsOnePulse) {
  SimulatorBench bench;
  bench.ask("T:M");
  EXPECT_EQ(bench.device.trigger_pulses(), 1);
  bench.ask("T:S");
  bench.ask("T:M");
  EXPECT_EQ(bench.device.trigger_pulses(), 2);
}

TEST(SimulatorTriggers, TimerCountsUntilItIsProhibited) {
  SimulatorBench bench;
  bench.wait(500ms);
  bench.ask("T:T100");
  bench.wait(999ms);
  EXPECT_EQ(bench.device.trigger_pulses(), 0);
  bench.wait(1ms);
  EXPECT_EQ(bench.device.trigger_pulses(), 1);
  bench.wait(9500ms);
  EXPECT_EQ(bench.device.trigger_pulses(), 10);
  bench.ask("T:S");
  bench.wait(10s);
  EXPECT_EQ(bench.device.trigger_pulses(), 10);
}

TEST(SimulatorTriggers, DrivePulsesCountInBothDirections) {
  SimulatorBench bench;
  bench.ask("T:P2P5");
  move(bench, "M:2+P103");
  EXPECT_EQ(bench.device.trigger_pulses(), 20);
  move(bench, "M:1+P100");
  EXPECT_EQ(bench.device.trigger_pulses(), 20);
  move(bench, "M:2-P2");  // 105 in total
  EXPECT_EQ(bench.device.trigger_pulses(), 21);
  bench.ask("PSET:2+P0");  // the counter's value does not matter
  move(bench, "A:2-P5");
  EXPECT_EQ(bench.device.trigger_pulses(), 22);
}

TEST(SimulatorTriggers, CountsWhileTheAxisRuns) {
  SimulatorBench bench;
  bench.ask("T:P1P100");
  bench.ask("J:1-");
  bench.ask("G:1");
  bench.wait(1s);  // at 1000 pulses/s
  EXPECT_EQ(bench.device.position(1), -1000);
  EXPECT_EQ(bench.device.trigger_pulses(), 10);
  bench.ask("JD:1F2000");
  bench.wait(1s);
  const auto gone = -bench.device.position(1);
  EXPECT_GT(gone, 2900);
  EXPECT_EQ(bench.device.trigger_pulses(), gone / 100);
  bench.ask("L:1");
  bench.rest();
  EXPECT_EQ(bench.device.trigger_pulses(), -bench.device.position(1) / 100);
}

TEST(SimulatorTriggers, ScalePulsesCountInOneDirectionAndNoPlaceTwice) {
  SimulatorBench bench;
  bench.ask("T:E1P+10");
  move(bench, "M:1-P100");
  EXPECT_EQ(bench.device.trigger_pulses(), 0);
  move(bench, "M:1+P155");  // up to +55
  EXPECT_EQ(bench.device.trigger_pulses(), 5);
  move(bench, "M:1-P50");
  move(bench, "M:1+P50");
  EXPECT_EQ(bench.device.trigger_pulses(), 5);
  move(bench, "M:1+P5");
  EXPECT_EQ(bench.device.trigger_pulses(), 6);
  bench.ask("T:E1P-10");
  move(bench, "M:1-P30");
  EXPECT_EQ(bench.device.trigger_pulses(), 9);
}

TEST(SimulatorTriggers, CountsTheWayOfAnArcThereAndBack) {
  SimulatorBench bench;
  bench.ask("T:P1P1000");
  move(bench, "E:0A0+P0+P5000");  // X goes to one side, then to the other, and back: 4 radii
  EXPECT_EQ(bench.device.trigger_pulses(), 20);
  bench.ask("T:E2P+1000");
  move(bench, "E:0A0+P0+P5000");  // Y goes 2 radii up, and back
  EXPECT_EQ(bench.device.trigger_pulses(), 30);
}

TEST(SimulatorTriggers, APowerCycleProhibits) {
  SimulatorBench bench;
  bench.ask("T:T1");
  bench.wait(105ms);
  ASSERT_EQ(bench.ask("RESET:"), "OK");
  bench.wait(2s);
  EXPECT_EQ(bench.ask("?:T"), "NS");
  EXPECT_EQ(bench.device.trigger_pulses(), 10);
}

}  // namespace
}  // namespace axisgate::shrc203::simulator::simulator_triggers_test
