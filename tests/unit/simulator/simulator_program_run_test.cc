// Running programs of the simulated SHRC-203 (manual 41), 105) to 110)).
#include <gtest/gtest.h>

#include "tests/unit/simulator/simulator_bench.h"

namespace axisgate::shrc203::simulator::simulator_program_run_test {
namespace {

using namespace std::chrono_literals;

using Lines = std::vector<std::string_view>;

// Enters program mode and stores the lines as program 1.
void store(SimulatorBench& bench, const Lines& lines) {
  ASSERT_EQ(bench.ask("P:R"), "OK");
  ASSERT_EQ(bench.ask("P:ON"), "OK");
  ASSERT_EQ(bench.ask("P:SET,1,NONE"), "OK");
  int number = 0;
  for (const std::string_view line : lines) {
    const std::string set = "P:SET," + std::to_string(++number) + "," + std::string(line);
    ASSERT_EQ(bench.ask(set), "OK") << set;
  }
  ASSERT_EQ(bench.ask("P:OFF"), "OK");
}

void start(SimulatorBench& bench, const Lines& lines) {
  store(bench, lines);
  ASSERT_EQ(bench.ask("P:C1"), "OK");
  ASSERT_EQ(bench.ask("P:T1"), "OK");
  ASSERT_EQ(bench.ask("P:S"), "OK");
}

TEST(SimulatorProgramRun, MovesWaitsLoopsAndEnds) {
  SimulatorBench bench;
  start(bench, {"A,1,1,0,-500,300,0,5,1,0,5", "F,2,3", "M,1,0,0,100,0,0,6,1,10,5", "N,2", "END"});
  EXPECT_EQ(bench.ask("?:L"), "1,1,1,0,0,0,0,0,0,0,0,0");
  for (const auto* line : {"P:S", "P:O", "P:H", "P:P1", "P:C1", "P:T1", "P:ON", "P:U1", "MODE:MANUAL"}) {
    EXPECT_EQ(bench.ask(line), "NG") << line;
  }
  EXPECT_EQ(bench.wait(20ms), "");
  EXPECT_EQ(bench.ask("!:S"), "B,B,R");
  EXPECT_EQ(bench.ask("?:O"), "5");
  EXPECT_EQ(bench.wait(980ms), "");
  EXPECT_EQ(bench.device.position(1), -400);
  EXPECT_EQ(bench.device.position(2), 300);
  EXPECT_EQ(bench.ask("!:"), "R");  // the program waits
  EXPECT_EQ(bench.ask("?:L"), "1,1,3,0,3,0,0,0,0,0,0,0");
  EXPECT_EQ(bench.ask("P:S"), "NG");
  EXPECT_EQ(bench.wait(1s), "");
  EXPECT_EQ(bench.ask("?:L"), "1,1,3,0,2,0,0,0,0,0,0,0");
  EXPECT_EQ(bench.rest(), "COMP");
  EXPECT_EQ(bench.device.position(1), -200);
  EXPECT_EQ(bench.device.starts(1), 4);
  EXPECT_EQ(bench.ask("?:O"), "6");
  EXPECT_EQ(bench.ask("?:L"), "1,0,5,0,0,0,0,0,0,0,0,0");
  EXPECT_EQ(bench.ask("P:H"), "OK");
}

TEST(SimulatorProgramRun, TellsItsEndOnlyWhereAskedTo) {
  SimulatorBench bench;
  start(bench, {"M,0,0,0,0,0,0,0,1,10,5"});
  EXPECT_EQ(bench.rest(), "COMP");
  EXPECT_EQ(bench.when_last_said(), 1002ms);  // two lines of 1 ms
  EXPECT_EQ(bench.ask("P:C0"), "OK");
  EXPECT_EQ(bench.ask("P:S"), "OK");
  EXPECT_EQ(bench.rest(), "");
  EXPECT_EQ(bench.ask("?:L"), "1,0,2,0,0,0,0,0,0,0,0,0");
}

TEST(SimulatorProgramRun, LoopsWithinLoops) {
  SimulatorBench bench;
  start(bench, {"F,1,2", "F,9,3", "M,0,0,1,0,0,10,0,1,0,5", "N,9", "M,0,0,1,0,0,1,0,1,0,5", "N,1"});
  EXPECT_EQ(bench.rest(), "COMP");
  EXPECT_EQ(bench.device.position(3), 62);
}

TEST(SimulatorProgramRun, PausesAndGoesOn) {
  SimulatorBench bench;
  start(bench, {"M,1,0,0,1000,0,0,0,1,10,5", "M,1,0,0,1000,0,0,0,1,0,5"});
  bench.wait(10ms);
  EXPECT_EQ(bench.ask("P:U0"), "OK");
  EXPECT_EQ(bench.ask("P:U0"), "NG");
  EXPECT_EQ(bench.ask("P:S"), "NG");
  EXPECT_EQ(bench.ask("P:O"), "NG");  // the axis still moves
  EXPECT_EQ(bench.ask("?:L"), "1,2,1,0,0,0,0,0,0,0,0,0");
  EXPECT_EQ(bench.rest(), "");
  EXPECT_EQ(bench.device.position(1), 1000);
  EXPECT_EQ(bench.ask("P:H"), "NG");
  EXPECT_EQ(bench.ask("P:U1"), "OK");
  EXPECT_EQ(bench.rest(), "COMP");
  EXPECT_EQ(bench.device.position(1), 2000);
}

TEST(SimulatorProgramRun, CarriesOutOneLineAtATime) {
  SimulatorBench bench;
  store(bench, {"M,1,0,0,1000,0,0,0,1,0,5", "M,1,0,0,500,0,0,0,1,0,5"});
  EXPECT_EQ(bench.ask("P:C1"), "OK");
  EXPECT_EQ(bench.ask("P:O"), "OK");
  EXPECT_EQ(bench.ask("?:L"), "1,3,1,0,0,0,0,0,0,0,0,0");
  EXPECT_EQ(bench.rest(), "");
  EXPECT_EQ(bench.device.position(1), 1000);
  EXPECT_EQ(bench.ask("?:L"), "1,2,2,0,0,0,0,0,0,0,0,0");
  EXPECT_EQ(bench.ask("P:O"), "OK");
  EXPECT_EQ(bench.rest(), "");
  EXPECT_EQ(bench.device.position(1), 1500);
  EXPECT_EQ(bench.ask("P:O"), "OK");
  EXPECT_EQ(bench.rest(), "COMP");
}

TEST(SimulatorProgramRun, Stops) {
  SimulatorBench bench;
  start(bench, {"M,1,1,0,100000,100000,0,0,1,0,4", "M,1,0,0,1000,0,0,0,1,0,5"});
  bench.wait(1s);
  EXPECT_EQ(bench.ask("P:E"), "OK");
  EXPECT_EQ(bench.ask("?:L"), "1,0,1,0,0,0,0,0,0,0,0,0");
  EXPECT_EQ(bench.ask("P:S"), "NG");  // the axis slows down
  EXPECT_EQ(bench.rest(), "");
  EXPECT_LT(bench.device.position(1), 60000);
  EXPECT_EQ(bench.device.starts(1), 1);
  EXPECT_EQ(bench.ask("P:S"), "OK");
}

TEST(SimulatorProgramRun, WaitsForTheInputs) {
  SimulatorBench bench;
  start(bench, {"INPUT,2", "M,1,0,0,10,0,0,0,1,0,5"});
  EXPECT_EQ(bench.wait(5s), "");
  EXPECT_EQ(bench.ask("?:L"), "1,1,1,0,0,0,0,0,0,0,0,0");
  bench.device.set_inputs(3);
  EXPECT_EQ(bench.rest(), "");
  bench.device.set_inputs(2);
  EXPECT_EQ(bench.rest(), "COMP");
  EXPECT_EQ(bench.device.position(1), 10);
}

TEST(SimulatorProgramRun, TellsOfItsTriggers) {
  SimulatorBench bench;
  start(bench, {"M,1,0,0,1000,0,0,0,1,3,4", "M,1,0,0,-100,0,0,0,1,0,0,1,40", "M,1,0,0,-100,0,0,0,1,0,6",
                "M,1,0,0,100,0,0,0,1,0,3,1,-40", "M,1,0,0,100,0,0,0,1,0,2,1,50", "M,1,0,0,100,0,0,0,1,0,5"});
  EXPECT_EQ(bench.wait(200ms), "TRIG");  // at the end of the first line, before its wait
  EXPECT_EQ(bench.ask("!:"), "R");
  EXPECT_EQ(bench.rest(), "TRIG TRIG TRIG TRIG TRIG TRIG COMP");
  EXPECT_EQ(bench.device.trigger_pulses(), 7);
  ASSERT_EQ(bench.ask("P:T0"), "OK");
  ASSERT_EQ(bench.ask("P:S"), "OK");
  EXPECT_EQ(bench.rest(), "COMP");
  EXPECT_EQ(bench.device.trigger_pulses(), 14);
}

TEST(SimulatorProgramRun, TriggersByTimeWhileItMoves) {
  SimulatorBench bench;
  start(bench, {"M,1,0,0,18000,0,0,0,1,5,1,1,10"});  // the motion takes 463 ms
  EXPECT_EQ(bench.wait(101ms), "TRIG");
  EXPECT_EQ(bench.rest(), "TRIG TRIG TRIG COMP");
}

TEST(SimulatorProgramRun, TriggersWhileItPausesToo) {
  SimulatorBench bench;
  start(bench, {"M,1,0,0,1000,0,0,0,1,0,0,1,250", "M,1,0,0,10,0,0,0,1,0,4"});
  bench.wait(10ms);
  EXPECT_EQ(bench.ask("P:U0"), "OK");
  EXPECT_EQ(bench.rest(), "TRIG TRIG TRIG TRIG");
  EXPECT_EQ(bench.ask("?:T"), "NS");
  EXPECT_EQ(bench.ask("P:U1"), "OK");
  EXPECT_EQ(bench.rest(), "TRIG COMP");
}

TEST(SimulatorProgramRun, MovesByTheSpeedChosen) {
  SimulatorBench bench;
  ASSERT_EQ(bench.ask("D:1S10F20R30"), "OK");
  start(bench, {"M,1,0,0,100,0,0,0,1,0,5"});
  EXPECT_EQ(bench.rest(), "COMP");
  EXPECT_EQ(bench.ask("?:D1"), "S1000F50000R100");
}

TEST(SimulatorProgramRun, ReturnsAndSetsTheOrigin) {
  SimulatorBench bench;
  start(bench, {"M,1,1,0,500,700,0,0,1,0,5", "R,1,0,0", "M,1,0,0,50,0,0,0,1,0,5", "Z,1,0,0,0,1,0,4", "H,0,1,0,7,0,5"});
  EXPECT_EQ(bench.rest(), "TRIG COMP");
  EXPECT_EQ(bench.device.position(1), 0);
  EXPECT_EQ(bench.device.position(2), 0);
  EXPECT_EQ(bench.ask("SRQ:2S"), "1000001,R");  // axis 2 is on its origin sensor
  EXPECT_EQ(bench.ask("?:O"), "7");
}

TEST(SimulatorProgramRun, GoesLinesArcsAndRegisteredPositions) {
  SimulatorBench bench;
  for (const auto* line : {"PSET:A+P100+P200", "PAV:SET,3", "PSET:A+P0+P0"}) ASSERT_EQ(bench.ask(line), "OK") << line;
  start(bench, {"PAV,1,1,0,3,0,1,0,4", "K,1,1,0,300,-400,0,0,1,0,4", "E,1,1,0,2,0,1000,90,0,1,0,4",
                "EH,1,1,0,0,100,0,50,2,0,1,0,4"});
  bench.rest();
  ASSERT_EQ(bench.ask("?:L"), "1,0,5,0,0,0,0,0,0,0,0,0");
  // 100, 200, then +300, -400, then a quarter turn CW around 0, 1000, then two whole turns.
  EXPECT_EQ(bench.device.position(1), 400 - 1000);
  EXPECT_EQ(bench.device.position(2), -200 + 1000);
  EXPECT_EQ(bench.device.position(3), 100);
}

TEST(SimulatorProgramRun, StopsWhereALineCannotBeCarriedOut) {
  Options two_axes;
  two_axes.axis_setting = 3;
  SimulatorBench other_axes({}, two_axes);
  start(other_axes, {"M,1,0,1,100,0,100,0,1,0,5"});
  EXPECT_EQ(other_axes.rest(), "");
  EXPECT_EQ(other_axes.ask("?:L"), "1,4,1,0,0,0,0,0,0,0,0,0");

  for (const auto* line : {"CM,1,0,0,100,0,0,0,1,0,0", "N,1", "PAV,1,0,0,20,0,1,0,5", "EH,0,1,1,1,0,9,9,1,0,1,0,5"}) {
    SimulatorBench bench;
    start(bench, {line});
    EXPECT_EQ(bench.rest(), "");
    EXPECT_EQ(bench.ask("?:L"), "1,6,1,0,0,0,0,0,0,0,0,0") << line;
    EXPECT_EQ(bench.ask("P:H"), "OK");
  }

  SimulatorBench unexcited;
  unexcited.ask("C:10");
  start(unexcited, {"M,0,1,0,0,100,0,0,1,0,5", "M,1,0,0,100,0,0,0,1,0,5"});
  EXPECT_EQ(unexcited.rest(), "");
  EXPECT_EQ(unexcited.ask("?:L"), "1,7,2,0,0,0,0,0,0,0,0,0");
  EXPECT_EQ(unexcited.device.position(2), 100);
}

TEST(SimulatorProgramRun, StopsAtAnError) {
  SimulatorBench bench;
  start(bench, {"M,1,0,0,3000000,0,0,0,1,0,4"});
  EXPECT_EQ(bench.rest(), "");
  EXPECT_EQ(bench.device.position(1), 2'000'000);
  EXPECT_EQ(bench.ask("?:L"), "1,5,1,0,0,0,0,0,0,0,0,0");
  EXPECT_EQ(bench.ask("P:S"), "OK");  // the limit error stays until BEC:
  EXPECT_EQ(bench.rest(), "");
  EXPECT_EQ(bench.ask("?:L"), "1,5,1,0,0,0,0,0,0,0,0,0");

  SimulatorBench stopped;
  start(stopped, {"M,1,0,0,0,0,0,0,1,2560,5"});
  stopped.wait(1s);
  EXPECT_EQ(stopped.ask("L:E"), "OK");
  EXPECT_EQ(stopped.ask("?:L"), "1,5,1,0,0,0,0,0,0,0,0,0");
  EXPECT_EQ(stopped.rest(), "");
}

TEST(SimulatorProgramRun, EndsWhenThePanelLeavesItsMode) {
  SimulatorBench bench;
  start(bench, {"M,1,0,0,10000,0,0,0,1,0,4", "M,1,0,0,10000,0,0,0,1,0,4"});
  bench.wait(100ms);
  bench.device.set_mode("MANUAL", bench.now());
  EXPECT_EQ(bench.rest(), "");
  EXPECT_EQ(bench.device.position(1), 10000);
  bench.device.set_mode("HOST", bench.now());
  EXPECT_EQ(bench.ask("?:L"), "1,0,1,0,0,0,0,0,0,0,0,0");
}

TEST(SimulatorProgramRun, SaysNothingWhileItIsStuck) {
  SimulatorBench bench;
  start(bench, {"M,1,0,0,100,0,0,0,1,0,4"});
  bench.device.be_stuck(5s, bench.now());
  EXPECT_EQ(bench.wait(4s), "");
  EXPECT_EQ(bench.wait(1s), "TRIG COMP");
}

}  // namespace
}  // namespace axisgate::shrc203::simulator::simulator_program_run_test
