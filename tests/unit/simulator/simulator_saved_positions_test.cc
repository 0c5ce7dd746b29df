// Registered positions of the simulated SHRC-203: PIT: (manual 127) to 131)) and PAV: (manual 132) to 136)).
#include <gtest/gtest.h>

#include "tests/unit/simulator/simulator_bench.h"

namespace axisgate::shrc203::simulator::simulator_saved_positions_test {
namespace {

using namespace std::chrono_literals;

void stand_at(SimulatorBench& bench, std::string_view targets) {
  ASSERT_EQ(bench.ask("A:W" + std::string(targets)), "OK");
  ASSERT_EQ(bench.ask("G:W"), "OK");
  bench.rest();
}

class SimulatorSavedPositions : public testing::TestWithParam<const char*> {
 protected:
  std::string with(std::string_view rest) const { return GetParam() + std::string(rest); }
};

INSTANTIATE_TEST_SUITE_P(Both, SimulatorSavedPositions, testing::Values("PIT:", "PAV:"),
                         [](const auto& tested) { return std::string(tested.param).substr(0, 3); });

TEST_P(SimulatorSavedPositions, TakesTheManualsExamples) {
  SimulatorBench bench;
  stand_at(bench, "+P10000+P5000+P10");
  EXPECT_EQ(bench.ask(with("SET,3")), "OK");
  EXPECT_EQ(bench.ask(with("GET,3")), "10000,5000,10");
  EXPECT_EQ(bench.ask(with("SET,1")), "OK");
  EXPECT_EQ(bench.ask(with("DEL,1")), "OK");
  EXPECT_EQ(bench.ask(with("GET,1")), "NG");
  EXPECT_EQ(bench.ask(with("SET,5")), "OK");
  stand_at(bench, "+P0+P0+P10");
  EXPECT_EQ(bench.ask(with("G,5")), "OK");
  EXPECT_EQ(bench.ask("!:"), "B");
  EXPECT_EQ(bench.rest(), "");
  EXPECT_EQ(bench.ask("Q:"), "+    10000,+     5000,+       10,K,K,R");
}

TEST_P(SimulatorSavedPositions, TellsEachAxisItsEnd) {
  SimulatorBench bench;
  stand_at(bench, "+P10000+P5000+P100");
  bench.ask(with("SET,5"));
  stand_at(bench, "+P0+P0+P0");
  EXPECT_EQ(bench.ask(with("GRT,5")), "OK");
  EXPECT_EQ(bench.rest(), "3 2 1");
  EXPECT_EQ(bench.device.position(1), 10000);
  EXPECT_EQ(bench.device.position(2), 5000);
  EXPECT_EQ(bench.device.position(3), 100);
  // All axes are there already, so their completions come at once.
  EXPECT_EQ(bench.ask(with("GRT,5")), "OK 1 2 3");
}

TEST_P(SimulatorSavedPositions, RunsAtTheSpeedOfD) {
  SimulatorBench bench;
  bench.ask("D:WS1000F1000R1S1000F1000R1S1000F1000R1");
  stand_at(bench, "+P2000+P0+P0");
  bench.ask(with("SET,1"));
  stand_at(bench, "+P0+P0+P0");
  bench.ask(with("GRT,1"));
  const auto begin = bench.elapsed();
  bench.wait(500ms);
  EXPECT_EQ(bench.device.position(1), 500);
  EXPECT_EQ(bench.wait(10s), "1");
  EXPECT_EQ(bench.when_last_said(), begin + 2s);
}

TEST_P(SimulatorSavedPositions, AStopTellsNothingAndTheRegistrationStays) {
  SimulatorBench bench;
  stand_at(bench, "+P10000+P0+P0");
  bench.ask(with("SET,1"));
  stand_at(bench, "+P0+P0+P0");
  bench.ask(with("GRT,1"));
  bench.wait(100ms);
  bench.ask("L:W");
  EXPECT_EQ(bench.rest(), "");
  EXPECT_LT(bench.device.position(1), 10000);
  EXPECT_EQ(bench.ask(with("GET,1")), "10000,0,0");
}

TEST_P(SimulatorSavedPositions, LeavesTheRegistersAlone) {
  SimulatorBench bench;
  bench.ask(with("SET,1"));
  stand_at(bench, "+P500+P0+P0");
  bench.ask("M:1+P7");
  ASSERT_EQ(bench.ask(with("G,1")), "OK");
  EXPECT_EQ(bench.ask("?:M1"), "7");
  EXPECT_EQ(bench.ask("?:A2"), "NS");
  bench.rest();
  EXPECT_EQ(bench.ask("G:1"), "OK");
  bench.rest();
  EXPECT_EQ(bench.device.position(1), 7);
}

TEST_P(SimulatorSavedPositions, RefusesOtherNumbersAndForms) {
  SimulatorBench bench;
  for (const auto* rest :
       {"",      "SET",    "SET,", "SET,0",  "SET,21", "SET1", "SET,1,2", "SET:1", "DEL,0",  "DEL,21",
        "GET,0", "GET,21", "GET",  "GETX,1", "G,0",    "G,21", "G",       "GRT,0", "GRT,21", "X,1"}) {
    EXPECT_EQ(bench.ask(with(rest)), "NG") << rest;
  }
  EXPECT_EQ(bench.ask(with("SET,20")), "OK");
  EXPECT_EQ(bench.ask(with("GET,20")), "0,0,0");
}

TEST_P(SimulatorSavedPositions, NothingRegisteredIsNoPlaceToGo) {
  SimulatorBench bench;
  for (const auto* rest : {"GET,1", "G,1", "GRT,1"}) EXPECT_EQ(bench.ask(with(rest)), "NG") << rest;
  EXPECT_EQ(bench.ask(with("DEL,1")), "OK");
}

TEST_P(SimulatorSavedPositions, BusyRefusesAllButTheQuestion) {
  SimulatorBench bench;
  bench.ask(with("SET,1"));
  bench.ask("J:2+");
  bench.ask("G:2");
  for (const auto* rest : {"SET,1", "DEL,1", "G,1", "GRT,1"}) EXPECT_EQ(bench.ask(with(rest)), "NG") << rest;
  EXPECT_EQ(bench.ask(with("GET,1")), "0,0,0");
}

TEST_P(SimulatorSavedPositions, MovesNothingWithoutMotors) {
  SimulatorBench bench;
  bench.ask("C:30");
  for (const auto* rest : {"SET,1", "GET,1", "DEL,2"}) EXPECT_NE(bench.ask(with(rest)), "NG") << rest;
  for (const auto* rest : {"G,1", "GRT,1"}) EXPECT_EQ(bench.ask(with(rest)), "NG") << rest;
  bench.ask("C:31");
  EXPECT_EQ(bench.ask(with("G,1")), "OK");
}

TEST_P(SimulatorSavedPositions, ConcernsTheControllableAxes) {
  Options options;
  options.axis_setting = 3;  // 1st and 2nd
  SimulatorBench bench({}, options);
  bench.ask("A:A+P10+P20");
  bench.ask("G");
  bench.rest();
  bench.ask(with("SET,1"));
  EXPECT_EQ(bench.ask(with("GET,1")), "10,20");
  bench.ask("Z:A");
  bench.rest();
  bench.ask(with("GRT,1"));
  EXPECT_EQ(bench.rest(), "1 2");
  EXPECT_EQ(bench.device.position(2), 20);
}

TEST(SimulatorSavedPositionsAndZero, APlaceStaysWhereItWas) {
  SimulatorBench bench;
  stand_at(bench, "+P1000+P0+P0");
  bench.ask("PIT:SET,1");
  bench.ask("PAV:SET,1");
  stand_at(bench, "+P1500+P0+P0");
  bench.ask("R:1");
  // Manual 129): the registered position and the coordinate just before it was zeroed.
  EXPECT_EQ(bench.ask("PIT:GET,1"), "-500,0,0");
  EXPECT_EQ(bench.ask("PAV:GET,1"), "1000,0,0");
  bench.ask("PIT:G,1");
  bench.rest();
  EXPECT_EQ(bench.device.position(1), -500);
  bench.ask("RC:1");
  EXPECT_EQ(bench.device.position(1), 1000);
  bench.ask("PSET:1+P0");
  bench.ask("PAV:G,1");
  bench.rest();
  EXPECT_EQ(bench.device.position(1), 1000);
}

TEST(SimulatorSavedPositionsAndZero, APlaceStaysWhereItWasWhenPulsesChange) {
  SimulatorBench bench;
  stand_at(bench, "+P1000+P0+P0");
  bench.ask("PIT:SET,1");
  stand_at(bench, "+P0+P0+P0");
  bench.ask("S:1,400");
  EXPECT_EQ(bench.ask("PIT:GET,1"), "2000,0,0");
}

TEST(SimulatorSavedPositionsAndZero, ARebootDiscardsPlacesOnly) {
  SimulatorBench bench;
  stand_at(bench, "+P1000+P0+P0");
  bench.ask("PIT:SET,1");
  bench.ask("PAV:SET,1");
  bench.ask("RESET:");
  bench.wait(2s);
  EXPECT_EQ(bench.ask("PIT:GET,1"), "NG");
  EXPECT_EQ(bench.ask("PAV:GET,1"), "1000,0,0");
  bench.ask("PIT:SET,1");
  bench.device.power_cycle(bench.now());
  bench.wait(2s);
  EXPECT_EQ(bench.ask("PIT:G,1"), "NG");
  EXPECT_EQ(bench.ask("PAV:GET,1"), "1000,0,0");
}

}  // namespace
}  // namespace axisgate::shrc203::simulator::simulator_saved_positions_test
