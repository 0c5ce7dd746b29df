// Actions of a person at the simulated device, and faults of the device.
#include <gtest/gtest.h>

#include "tests/unit/simulator/simulator_bench.h"

namespace axisgate::shrc203::simulator::simulator_panel_test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

// Hexadecimal status for the bits that manual 5) Q:S numbers: 4 for bit 3, 8 for bit 4, 10 for bit 5.
TEST(SimulatorPanel, ErrorsShowInTheStatusAndStopTheAxis) {
  struct Case {
    AxisError error;
    const char* status;
  };
  for (const Case& shown :
       {Case{AxisError::scale, "4"}, {AxisError::disconnection, "8"}, {AxisError::overflow, "10"}}) {
    SimulatorBench bench;
    EXPECT_EQ(bench.send("MP:1+P500000\r\nG:1\r\n"), "OK OK");
    bench.wait(seconds(1));
    const std::int64_t before = bench.device.position(1);
    bench.device.set_error(1, shown.error, true, bench.now());
    EXPECT_EQ(bench.wait(seconds(20)), "") << "no completion of what did not end well";
    EXPECT_EQ(bench.device.position(1), before);
    EXPECT_EQ(bench.ask("SRQ:1S"), std::string(shown.status) + ",R");
    EXPECT_EQ(bench.ask("SRQ:2S"), "1,R");
    EXPECT_EQ(bench.ask("SRQ:"), "K,R,R");
    EXPECT_EQ(bench.ask("M:1+P1"), "NG");
    EXPECT_EQ(bench.ask("M:2+P1"), "OK");
    // Manual 53): BEC: cancels limit errors, overflow errors and the emergency stop.
    EXPECT_EQ(bench.ask("BEC:1"), "OK");
    const bool cleared = shown.error == AxisError::overflow;
    EXPECT_EQ(bench.ask("SRQ:1S"), cleared ? "1,R" : std::string(shown.status) + ",R");
    bench.device.set_error(1, shown.error, false, bench.now());
    EXPECT_EQ(bench.ask("SRQ:1S"), "1,R");
    EXPECT_EQ(bench.ask("M:1+P1"), "OK");
  }
}

// Manual 46): a reboot. The memory switches decide its end state; the stage does not move.
TEST(SimulatorPanel, ComesBackAsItsMemorySwitchesSay) {
  SimulatorBench bench;
  EXPECT_EQ(bench.send("M:1+P700\r\nG:1\r\n"), "OK OK");
  bench.rest();
  bench.device.set_boot({"MANUAL", "SHOT_FC", milliseconds(300)});
  bench.device.power_cycle(bench.now());
  EXPECT_EQ(bench.ask("*IDN?"), "") << "it boots";
  bench.wait(milliseconds(300));
  EXPECT_EQ(bench.ask("?:MODE"), "MANUAL");
  EXPECT_EQ(bench.ask("Q:"), "NG");
  EXPECT_EQ(bench.ask("MODE:HOST"), "OK");
  EXPECT_EQ(bench.ask("Q:SPC"), "P+0,P+0,P+0,1,1,1,R,R,R");
  bench.device.set_boot({"HOST", "HIT", milliseconds(100)});
  EXPECT_EQ(bench.ask("RESET:"), "OK");
  bench.wait(milliseconds(100));
  EXPECT_EQ(bench.ask("?:FMT"), "HIT");
}

// In HIT format a few answers have other shapes, and most commands are unknown.
TEST(SimulatorPanel, Format) {
  SimulatorBench bench;
  EXPECT_EQ(bench.send("M:1+P50000\r\nG:1\r\n"), "OK OK");
  bench.device.set_format("HIT", bench.now());
  EXPECT_EQ(bench.ask("!:"), "1,0,0");
  EXPECT_EQ(bench.ask("Q:"), "0,0,0");
  EXPECT_EQ(bench.ask("Q:SPC"), "NG");
  EXPECT_EQ(bench.ask("L:1"), "NG");
  EXPECT_EQ(bench.ask("?:MODE"), "HOST");
  bench.device.set_format("SHOT_FC", bench.now());
  EXPECT_EQ(bench.ask("!:S"), "B,R,R");
}

// Manual 47): sleep is refused while BUSY; commands that need a motor are refused during sleep.
TEST(SimulatorPanel, Sleep) {
  SimulatorBench bench;
  EXPECT_EQ(bench.send("M:1+P50000\r\nG:1\r\n"), "OK OK");
  EXPECT_FALSE(bench.device.set_sleep(true, bench.now()));
  EXPECT_EQ(bench.ask("?:SLEEP"), "0");
  bench.rest();
  EXPECT_TRUE(bench.device.set_sleep(true, bench.now()));
  EXPECT_EQ(bench.ask("?:SLEEP"), "1");
  EXPECT_EQ(bench.ask("M:1+P1"), "NG");
  EXPECT_EQ(bench.ask("SLEEP:0"), "OK");
  EXPECT_EQ(bench.ask("M:1+P1"), "OK");
}

// Manual 1), 43): answers to *IDN? and ?:SN.
TEST(SimulatorPanel, AnotherUnit) {
  SimulatorBench bench;
  bench.device.set_serial_number("2106001002");
  EXPECT_EQ(bench.ask("*IDN?"), "SIGMAKOKI,SHRC-203,2106001002,V2.00.000");
  EXPECT_EQ(bench.ask("?:SN"), "2106001002");
}

TEST(SimulatorPanel, SlowAnswersComeInOrderEachAfterItsPredecessor) {
  SimulatorBench bench;
  bench.device.set_answer_delay(milliseconds(100), bench.now());
  EXPECT_EQ(bench.ask("?:N"), "");
  EXPECT_EQ(bench.ask("?:SN"), "");
  EXPECT_EQ(bench.wait(milliseconds(99)), "");
  EXPECT_EQ(bench.wait(milliseconds(1)), "SHRC-203");
  EXPECT_EQ(bench.wait(milliseconds(99)), "");
  EXPECT_EQ(bench.wait(milliseconds(1)), "2106001001");
  EXPECT_EQ(bench.ask("M:1+P100"), "");
  bench.wait(milliseconds(50));
  EXPECT_EQ(bench.ask("G:1"), "");
  EXPECT_EQ(bench.wait(milliseconds(50)), "OK");
  EXPECT_FALSE(bench.device.busy(1)) << "not carried out before its time";
  EXPECT_EQ(bench.wait(milliseconds(100)), "OK");
  EXPECT_TRUE(bench.device.busy(1));
  bench.device.set_answer_delay({}, bench.now());
  EXPECT_EQ(bench.ask("?:N"), "SHRC-203");
}

TEST(SimulatorPanel, StuckReadsAndAnswersLater) {
  SimulatorBench bench;
  EXPECT_EQ(bench.send("MP:2+P50\r\nG:2\r\n"), "OK OK");
  bench.device.be_stuck(seconds(3), bench.now());
  EXPECT_EQ(bench.ask("?:N"), "");
  EXPECT_EQ(bench.ask("!:S"), "");
  EXPECT_EQ(bench.wait(milliseconds(2999)), "");
  EXPECT_EQ(bench.wait(milliseconds(1)), "2 SHRC-203 R,R,R");
  EXPECT_EQ(bench.ask("?:N"), "SHRC-203");
  EXPECT_EQ(bench.device.received().size(), 5u);
}

TEST(SimulatorPanel, RebootForgetsWhatWasNotAnswered) {
  SimulatorBench bench;
  bench.device.be_stuck(seconds(3), bench.now());
  bench.ask("?:N");
  bench.device.power_cycle(bench.now());
  EXPECT_EQ(bench.wait(seconds(5)), "");
  EXPECT_EQ(bench.ask("?:N"), "SHRC-203");
}

}  // namespace
}  // namespace axisgate::shrc203::simulator::simulator_panel_test
