// The double buffer of manual section 2, with the first value of every option.
#include <gtest/gtest.h>

#include "tests/unit/simulator/simulator_bench.h"

namespace axisgate::shrc203::simulator::simulator_double_buffer_test {
namespace {

using namespace std::chrono_literals;

// 1000 pulses take one second on every axis.
class SimulatorDoubleBuffer : public ::testing::Test {
 protected:
  SimulatorDoubleBuffer() { bench.ask("D:WS1000F1000R1 S1000F1000R1 S1000F1000R1"); }
  SimulatorBench bench;
};

TEST_F(SimulatorDoubleBuffer, BeforeTheStartItIsOkAndCanBeOverwritten) {
  EXPECT_EQ(bench.ask("MP:1+P1000"), "OK");
  EXPECT_EQ(bench.ask("MP:1+P2000"), "OK");
  EXPECT_EQ(bench.ask("?:MP1"), "2000");
  EXPECT_EQ(bench.ask("AP:1+P3000"), "OK");
  EXPECT_EQ(bench.ask("?:MP1"), "NS");
  EXPECT_EQ(bench.ask("?:AP1"), "3000");
  EXPECT_EQ(bench.ask("G:1"), "OK");
  EXPECT_EQ(bench.ask("?:AP1"), "NS");
  EXPECT_EQ(bench.ask("?:A1"), "3000");  // migrated to the execution buffer
  EXPECT_EQ(bench.rest(), "1");
  EXPECT_EQ(bench.ask("?:A1"), "NS");
}

TEST_F(SimulatorDoubleBuffer, InOperationItIsOkDAndFollowsByItself) {
  bench.ask("MP:1+P1000");
  bench.ask("G:1");
  EXPECT_EQ(bench.ask("MP:1+P500"), "OK_D");
  EXPECT_EQ(bench.ask("MP:1+P2000"), "OK_D");
  EXPECT_EQ(bench.ask("?:MP1"), "2000");
  EXPECT_EQ(bench.wait(1s), "1");
  EXPECT_EQ(bench.ask("?:MP1"), "NS");
  EXPECT_EQ(bench.ask("!:1S"), "B");
  EXPECT_EQ(bench.ask("AP:1+P0"), "OK_D");
  EXPECT_EQ(bench.wait(2s + 5ms), "1");
  EXPECT_EQ(bench.device.position(1), 3000);
  EXPECT_EQ(bench.rest(), "1");
  EXPECT_EQ(bench.device.position(1), 0);
  EXPECT_EQ(bench.device.starts(1), 3);
}

TEST_F(SimulatorDoubleBuffer, ALateSettingEndsTheChainAndWaitsForGo) {
  bench.ask("MP:1+P1000");
  bench.ask("G:1");
  EXPECT_EQ(bench.wait(1s), "1");
  EXPECT_EQ(bench.ask("!:1S"), "B");  // still settling, but the operation has ended
  EXPECT_EQ(bench.ask("MP:1+P500"), "OK");
  EXPECT_EQ(bench.ask("G:1"), "NG");
  EXPECT_EQ(bench.rest(), "");
  EXPECT_EQ(bench.device.position(1), 1000);
  EXPECT_EQ(bench.ask("G:1"), "OK");
  EXPECT_EQ(bench.rest(), "1");
  EXPECT_EQ(bench.device.position(1), 1500);
}

TEST_F(SimulatorDoubleBuffer, SpeedsOverwriteThoseOfDAtTheStart) {
  bench.ask("MP:1+P1000");
  bench.ask("G:1");
  ASSERT_EQ(bench.ask("MP:1+P1000,S500F500R50"), "OK_D");
  EXPECT_EQ(bench.ask("?:D1"), "S1000F1000R1");
  bench.wait(1s + 5ms);
  EXPECT_EQ(bench.ask("?:D1"), "S500F500R50");
  bench.rest();
  EXPECT_EQ(bench.elapsed(), 1s + 5ms + 2s + 5ms);
}

TEST_F(SimulatorDoubleBuffer, StraightLinesChainAndTellEachAxis) {
  bench.ask("KP:A+P600+P800");
  bench.ask("G:A");
  EXPECT_EQ(bench.ask("KP:B+P600-P800"), "OK_D");
  EXPECT_EQ(bench.wait(1s), "1 2");
  EXPECT_EQ(bench.ask("?:KP"), "NS");
  EXPECT_EQ(bench.ask("?:K"), "B,600,-800");
  EXPECT_EQ(bench.rest(), "1 3");
  EXPECT_EQ(bench.ask("Q:SP").substr(0, 20), "P+1200,P+800,P-800,1");
}

TEST_F(SimulatorDoubleBuffer, WaitsAreSegmentsOfTheChain) {
  bench.ask("MP:1+P1000");
  bench.ask("G:1");
  EXPECT_EQ(bench.ask("WT:1,10"), "OK");
  EXPECT_EQ(bench.ask("?:WT1"), "10");
  EXPECT_EQ(bench.wait(1s), "1");
  EXPECT_EQ(bench.ask("?:WT1"), "NS");
  EXPECT_EQ(bench.ask("MP:1+P1000"), "OK_D");
  EXPECT_EQ(bench.wait(1s), "");
  EXPECT_EQ(bench.device.position(1), 1000);
  EXPECT_EQ(bench.ask("!:1S"), "B");
  EXPECT_EQ(bench.rest(), "1");
  EXPECT_EQ(bench.when_last_said(), 1s + 5ms + 1s + 1s);
  EXPECT_EQ(bench.device.starts(1), 2);
}

TEST_F(SimulatorDoubleBuffer, AWaitCanBeCancelled) {
  for (const auto* cancel : {"WT:1,0", "WT:1,C"}) {
    bench.ask("WT:1,2550");
    ASSERT_EQ(bench.ask("G:1"), "OK");
    ASSERT_EQ(bench.ask("MP:1+P1000"), "OK_D");
    bench.wait(1s);
    EXPECT_EQ(bench.ask(cancel), "OK");
    EXPECT_EQ(bench.wait(1s), "1") << cancel;
    bench.rest();
  }
}

TEST_F(SimulatorDoubleBuffer, WaitsForInputs) {
  bench.ask("WI:1,5");
  bench.ask("G:1");
  bench.ask("MP:1+P1000");
  EXPECT_EQ(bench.wait(1h), "");
  EXPECT_EQ(bench.ask("!:1S"), "B");
  bench.device.set_inputs(7);
  bench.wait(1s);
  EXPECT_EQ(bench.device.position(1), 0);
  bench.device.set_inputs(5);
  EXPECT_EQ(bench.wait(1s), "1");
  bench.rest();
  bench.ask("WI:1,63");
  bench.ask("G:1");
  EXPECT_EQ(bench.ask("!:1S"), "B");
  EXPECT_EQ(bench.ask("WI:W,C"), "OK");
  EXPECT_EQ(bench.ask("!:1S"), "R");
}

TEST_F(SimulatorDoubleBuffer, PlainMovesSendNothing) {
  bench.ask("M:1+P10");
  bench.ask("G:1");
  EXPECT_EQ(bench.rest(), "");
  bench.ask("K:A+P10+P10");
  bench.ask("G");
  EXPECT_EQ(bench.rest(), "");
}

TEST_F(SimulatorDoubleBuffer, GoNamesItsAxes) {
  bench.ask("MP:A+P1000+P1000");
  EXPECT_EQ(bench.ask("G:2"), "OK");
  EXPECT_EQ(bench.rest(), "2");
  EXPECT_EQ(bench.ask("?:MP"), "1000,NS,NS");
  bench.ask("K:B+P10+P10");
  EXPECT_EQ(bench.ask("G:1"), "NG");
}

TEST_F(SimulatorDoubleBuffer, ASettingDuringAStopWaitsForGo) {
  bench.ask("D:1S1000F11000R100");
  bench.ask("MP:1+P100000");
  bench.ask("G:1");
  bench.wait(1s);
  bench.ask("L:1");
  EXPECT_EQ(bench.ask("!:1S"), "B");
  EXPECT_EQ(bench.ask("MP:1+P500"), "OK");
  EXPECT_EQ(bench.rest(), "");
  EXPECT_EQ(bench.ask("?:MP1"), "500");
  EXPECT_EQ(bench.device.starts(1), 1);
}

TEST_F(SimulatorDoubleBuffer, TwentySegmentsKeptFull) {
  bench.ask("KP:A+P600+P800");
  bench.ask("G:A");
  for (int sent = 1; sent < 20; ++sent) {
    ASSERT_EQ(bench.ask("KP:A+P600+P800"), "OK_D") << sent;
    ASSERT_EQ(bench.wait(1005ms), "1 2") << sent;
  }
  EXPECT_EQ(bench.rest(), "1 2");
  EXPECT_EQ(bench.device.position(1), 12000);
  EXPECT_EQ(bench.device.position(2), 16000);
  EXPECT_EQ(bench.device.starts(1), 20);
}

}  // namespace
}  // namespace axisgate::shrc203::simulator::simulator_double_buffer_test
