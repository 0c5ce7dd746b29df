// Memory switches of the simulated SHRC-203: their edit mode, and their effects at power-on.
#include <gtest/gtest.h>

#include "tests/unit/simulator/simulator_bench.h"

namespace axisgate::shrc203::simulator::simulator_memory_switches_test {
namespace {

using namespace std::chrono_literals;

void power_cycle(SimulatorBench& bench) {
  bench.device.power_cycle(bench.now());
  bench.wait(1s);
}

// Sends the lines in edit mode, saves them and cycles the power.
void keep(SimulatorBench& bench, std::initializer_list<const char*> lines) {
  ASSERT_EQ(bench.ask("MS:ON"), "OK");
  for (const char* line : lines) ASSERT_EQ(bench.ask(line), "OK") << line;
  ASSERT_EQ(bench.ask("MS:OFF"), "OK");
  power_cycle(bench);
}

TEST(SimulatorMemorySwitches, TakesTheManualsExamples) {
  SimulatorBench bench;
  EXPECT_EQ(bench.ask("MS:ON"), "OK");            // 117)
  EXPECT_EQ(bench.ask("?:MODE"), "HOST,MS");      // 37)
  EXPECT_EQ(bench.ask("MS:SET,0,1,1"), "OK");     // 119)
  EXPECT_EQ(bench.ask("MS:SET,5,4,1000"), "OK");  // 119)
  EXPECT_EQ(bench.ask("MS:GET,0,1"), "1");        // 120)
  EXPECT_EQ(bench.ask("MS:DEF,0,1"), "OK");       // 121)
  EXPECT_EQ(bench.ask("MS:GET,0,1"), "0");
  EXPECT_EQ(bench.ask("MS:DEFR,0,0"), "6");                   // 122)
  EXPECT_EQ(bench.ask("MS:SETK,0,6,0,1,1,0,1,0,0,0"), "OK");  // 123)
  EXPECT_EQ(bench.ask("MS:GETK,0"), "6,0,1,1,0,1,0,0,0");     // 124)
  EXPECT_EQ(bench.ask("MS:DEFK,0"), "OK");                    // 125)
  EXPECT_EQ(bench.ask("MS:DEFRK,0"), "6,0,1,1,0,1,0,0,0");    // 126)
  EXPECT_EQ(bench.ask("MS:OFF"), "OK");                       // 118)
  EXPECT_EQ(bench.ask("?:MODE"), "HOST");
}

TEST(SimulatorMemorySwitches, AllOfAnItemIsSetToldAndInitialized) {
  SimulatorBench bench;
  ASSERT_EQ(bench.ask("MS:ON"), "OK");
  for (const char item : std::string("012345678")) {
    const std::string number(1, item);
    const std::string initial = bench.ask("MS:DEFRK," + number);
    EXPECT_NE(initial, "NG") << item;
    EXPECT_EQ(bench.ask("MS:GETK," + number), initial) << item;
    EXPECT_EQ(bench.ask("MS:SETK," + number + "," + initial), "OK") << item;
    EXPECT_EQ(bench.ask("MS:SETK," + number + "," + initial + ",0"), "NG") << item;
    EXPECT_EQ(bench.ask("MS:DEFK," + number), "OK") << item;
  }
  EXPECT_EQ(bench.ask("ms:set, 0, 3, 0"), "OK");
  EXPECT_EQ(bench.ask("MS:GETK,0"), "6,0,1,0,0,1,0,0,0");
  EXPECT_EQ(bench.ask("MS:DEFRK,0"), "6,0,1,1,0,1,0,0,0");
  EXPECT_EQ(bench.ask("MS:DEFK,0"), "OK");
  EXPECT_EQ(bench.ask("MS:GETK,0"), "6,0,1,1,0,1,0,0,0");
}

TEST(SimulatorMemorySwitches, RefusesWhatThereIsNot) {
  SimulatorBench bench;
  ASSERT_EQ(bench.ask("MS:ON"), "OK");
  for (const auto* line : {"MS:",
                           "MS:ON",
                           "MS:ON,1",
                           "MS:OFF,1",
                           "MS:SET",
                           "MS:SET,0",
                           "MS:SET,0,1",
                           "MS:SET,0,1,",
                           "MS:SET,0,1,6",
                           "MS:SET,0,1,-1",
                           "MS:SET,0,1,1,1",
                           "MS:SET,0,9,0",
                           "MS:SET,9,0,0",
                           "MS:SET,5,1,0",
                           "MS:SET,5,1,1000001",
                           "MS:SET,5,3,1001",
                           "MS:SET,4,0,7",
                           "MS:SET,0,0,7",
                           "MS:SET,0,1,MANUAL",
                           "MS:SETK,0,6,0,1,1,0,1,0,0",
                           "MS:SETK,0,6,0,1,1,0,1,0,0,10",
                           "MS:GET,0",
                           "MS:GET,0,9",
                           "MS:GET,9,0",
                           "MS:GET,0,1,1",
                           "MS:GETK",
                           "MS:GETK,9",
                           "MS:GETK,0,1",
                           "MS:DEF,0",
                           "MS:DEF,0,9",
                           "MS:DEFK,9",
                           "MS:DEFR,0",
                           "MS:DEFR,9,0",
                           "MS:DEFRK,9",
                           "MS:DEFRKX,0",
                           "MS:K,0"}) {
    EXPECT_EQ(bench.ask(line), "NG") << line;
  }
  EXPECT_EQ(bench.ask("MS:GETK,0"), "6,0,1,1,0,1,0,0,0");
}

TEST(SimulatorMemorySwitches, NothingElseWorksWhileTheyAreEdited) {
  SimulatorBench bench;
  ASSERT_EQ(bench.ask("MS:ON"), "OK");
  for (const auto* line : {"!:", "Q:", "Q:S", "SRQ:", "I:", "M:1+P1", "G:1", "L:W", "L:E", "D:1S1F1R1",
                           "RESET:", "MODE:HOST", "FMT:HIT", "BEEP:0", "C:10", "BEC:", "MS:ON"}) {
    EXPECT_EQ(bench.ask(line), "NG") << line;
  }
  EXPECT_EQ(bench.ask("*IDN?"), "SIGMAKOKI,SHRC-203,2106001001,V2.00.000");
  EXPECT_EQ(bench.ask("?:AXIS"), "6");
  EXPECT_EQ(bench.ask("?:D1"), "S1000F50000R100");
  EXPECT_EQ(bench.ask("BEEP?"), "1");
  EXPECT_EQ(bench.ask("MS:OFF"), "OK");
  EXPECT_EQ(bench.ask("!:"), "R");
}

TEST(SimulatorMemorySwitches, AreEditedInTheirModeOnly) {
  SimulatorBench bench;
  for (const auto* line : {"MS:OFF", "MS:SET,0,1,1", "MS:GET,0,1", "MS:DEF,0,1", "MS:DEFR,0,0",
                           "MS:SETK,0,6,0,1,1,0,1,0,0,0", "MS:GETK,0", "MS:DEFK,0", "MS:DEFRK,0"}) {
    EXPECT_EQ(bench.ask(line), "NG") << line;
  }
}

TEST(SimulatorMemorySwitches, TheirModeIsEnteredFromHostAtRest) {
  SimulatorBench bench;
  bench.ask("J:1+");
  ASSERT_EQ(bench.ask("G:1"), "OK");
  EXPECT_EQ(bench.ask("MS:ON"), "NG");
  bench.ask("L:W");
  bench.rest();
  ASSERT_EQ(bench.ask("MODE:MANUAL"), "OK");
  EXPECT_EQ(bench.ask("MS:ON"), "NG");
  ASSERT_EQ(bench.ask("MODE:HOST"), "OK");
  ASSERT_EQ(bench.ask("FMT:HIT"), "OK");
  EXPECT_EQ(bench.ask("MS:ON"), "NG");
  ASSERT_EQ(bench.ask("FMT:SHOT_FC"), "OK");
  EXPECT_EQ(bench.ask("MS:ON"), "OK");
}

TEST(SimulatorMemorySwitches, AreKeptOnceSavedAndTakeEffectAtPowerOn) {
  SimulatorBench bench;
  ASSERT_EQ(bench.ask("MS:ON"), "OK");
  ASSERT_EQ(bench.ask("MS:SET,5,4,2000"), "OK");
  power_cycle(bench);  // not saved
  ASSERT_EQ(bench.ask("MS:ON"), "OK");
  EXPECT_EQ(bench.ask("MS:GET,5,4"), "1000");
  ASSERT_EQ(bench.ask("MS:SET,5,4,2000"), "OK");
  ASSERT_EQ(bench.ask("MS:OFF"), "OK");
  EXPECT_EQ(bench.ask("?:D"), "S1000F50000R100,S1000F50000R100,S1000F50000R100");
  EXPECT_EQ(bench.ask("RESET:"), "OK");
  bench.wait(1s);
  EXPECT_EQ(bench.ask("?:D"), "S1000F50000R100,S2000F50000R100,S1000F50000R100");
  power_cycle(bench);
  ASSERT_EQ(bench.ask("MS:ON"), "OK");
  EXPECT_EQ(bench.ask("MS:GET,5,4"), "2000");
  EXPECT_EQ(bench.ask("MS:DEFR,5,4"), "1000");
}

TEST(SimulatorMemorySwitches, WhatThePanelLeavesUnsavedIsLost) {
  SimulatorBench bench;
  ASSERT_EQ(bench.ask("MS:ON"), "OK");
  ASSERT_EQ(bench.ask("MS:SET,0,3,0"), "OK");
  bench.device.set_mode("HOST", bench.now());
  ASSERT_EQ(bench.ask("MS:ON"), "OK");
  EXPECT_EQ(bench.ask("MS:GET,0,3"), "1");
}

TEST(SimulatorMemorySwitches, GeneralSaysHowItComesOn) {
  SimulatorBench bench;
  keep(bench, {"MS:SETK,0,3,0,1,0,0,1,0,0,0"});
  EXPECT_EQ(bench.ask("?:AXIS"), "3");
  EXPECT_EQ(bench.ask("?:S"), "200,200");
  EXPECT_EQ(bench.ask("M:3+P1"), "NG");
  EXPECT_EQ(bench.ask("?:BEEP"), "0");
  keep(bench, {"MS:SET,0,1,1"});
  EXPECT_EQ(bench.ask("?:MODE"), "MANUAL");
  EXPECT_EQ(bench.ask("MODE:HOST"), "OK");
  keep(bench, {"MS:DEFK,0", "MS:SET,0,6,1"});
  EXPECT_EQ(bench.ask("?:MODE"), "HOST");
  EXPECT_EQ(bench.ask("?:FMT"), "HIT");
  EXPECT_EQ(bench.ask("!:"), "0,0,0");
}

TEST(SimulatorMemorySwitches, SpeedsFollowTheSpeedSelected) {
  SimulatorBench bench;
  // SPEED21 comes after the three entries of SPEED1, each with S, F and R.
  keep(bench, {"MS:SET,5,10,200", "MS:SET,5,11,3000", "MS:SET,5,12,40"});
  EXPECT_EQ(bench.ask("?:D1"), "S1000F50000R100");
  keep(bench, {"MS:SET,5,0,1"});
  EXPECT_EQ(bench.ask("?:D"), "S200F3000R40,S1000F50000R100,S1000F50000R100");
  keep(bench, {"MS:SET,5,11,100"});  // F is below S
  EXPECT_EQ(bench.ask("?:D1"), "S100F100R40");
}

// A public client sets these three values for its origin returns.
TEST(SimulatorMemorySwitches, OriginSpeedsStandFromNumberNine) {
  SimulatorBench bench;
  keep(bench, {"MS:SET,6,9,2000", "MS:SET,6,12,2000", "MS:SET,6,15,2000"});
  EXPECT_EQ(bench.ask("?:B"), "S2000F500000R100,S2000F500000R100,S2000F500000R100");
}

TEST(SimulatorMemorySwitches, AxisAndDriverSayWhatAPulseIsAndItsName) {
  SimulatorBench bench;
  keep(bench, {"MS:SET,3,0,9", "MS:SET,3,3,0", "MS:SET,3,5,4", "MS:SET,3,6,400", "MS:SET,4,1,400"});
  EXPECT_EQ(bench.ask("?:AN"), "A,2,3");
  EXPECT_EQ(bench.ask("?:S"), "200,400,200");
  EXPECT_EQ(bench.ask("?:P"), "20,5,10");  // BASE RATE * 10 / DIVIDE
  EXPECT_EQ(bench.ask("PSET:1+P5"), "OK");
  EXPECT_EQ(bench.ask("Q:S"), "P+5,U+0,D+0,1,1,1,R,R,R");
  keep(bench, {"MS:DEFK,3", "MS:DEFK,4"});
  EXPECT_EQ(bench.ask("?:P"), "10,10,10");
  EXPECT_EQ(bench.ask("Q:S"), "U+0,U+0,U+0,1,1,1,R,R,R");
}

// The formula is in manual 10).
TEST(SimulatorMemorySwitches, BaseRateAndDivideAreThoseOfTheManualsFormula) {
  SimulatorBench bench;
  keep(bench, {"MS:SET,3,6,200", "MS:SET,4,0,2000"});
  EXPECT_EQ(bench.ask("?:P1"), "1");
}

TEST(SimulatorMemorySwitches, ConfigMakesDivideFixed) {
  SimulatorBench bench;
  EXPECT_EQ(bench.ask("?:ACS"), "0,0,0");
  keep(bench, {"MS:SET,3,10,1"});
  EXPECT_EQ(bench.ask("?:ACS"), "0,1,0");
  EXPECT_EQ(bench.ask("S:2,100"), "NG");
  EXPECT_EQ(bench.ask("S:1,100"), "OK");
}

TEST(SimulatorMemorySwitches, MotorsCanStayExcitedInAnEmergency) {
  SimulatorBench bench;
  keep(bench, {"MS:SET,3,12,1"});
  EXPECT_EQ(bench.ask("L:E"), "OK");
  EXPECT_EQ(bench.ask("?:C"), "1,0,0");
}

TEST(SimulatorMemorySwitches, AUnitOfOtherSettingsHasItsOwn) {
  Options options;
  options.axis_setting = 3;
  options.axes[1].maximum_speed = 7000;
  options.axes[2].nm_per_pulse_e6 = 2'345'678;
  SimulatorBench bench({{"emergency_excitation", "on"}}, options);
  ASSERT_EQ(bench.ask("MS:ON"), "OK");
  EXPECT_EQ(bench.ask("MS:GET,0,0"), "3");
  EXPECT_EQ(bench.ask("MS:DEFR,0,0"), "6");
  EXPECT_EQ(bench.ask("MS:GET,5,5"), "7000");
  EXPECT_EQ(bench.ask("MS:GET,3,12"), "1");
  EXPECT_EQ(bench.ask("MS:SET,0,0,6"), "OK");
  ASSERT_EQ(bench.ask("MS:OFF"), "OK");
  power_cycle(bench);
  EXPECT_EQ(bench.ask("?:P3"), "2.345678");
}

}  // namespace
}  // namespace axisgate::shrc203::simulator::simulator_memory_switches_test
