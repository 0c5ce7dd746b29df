// Effects of the simulated SHRC-203's setting commands outside the double buffer, and their refusals.
#include <gtest/gtest.h>

#include "tests/unit/simulator/simulator_bench.h"

namespace axisgate::shrc203::simulator::simulator_settings_test {
namespace {

using namespace std::chrono_literals;

TEST(SimulatorSettings, TakesTheManualsSpeedExamples) {
  SimulatorBench bench;
  EXPECT_EQ(bench.ask("D:1S100F1000R100"), "OK");
  EXPECT_EQ(bench.ask("D:AS100F1000R100 S200F2000R200"), "OK");
  EXPECT_EQ(bench.ask("DS:1F100"), "OK");
  EXPECT_EQ(bench.ask("DS:BF100F300"), "OK");
  EXPECT_EQ(bench.ask("DF:WF1000F2000F3000"), "OK");
  EXPECT_EQ(bench.ask("DF:WM0.01M0.02M0.03"), "OK");
  EXPECT_EQ(bench.ask("?:DF"), "1000,2000,3000");
  EXPECT_EQ(bench.ask("DR:1 50"), "OK");
  EXPECT_EQ(bench.ask("DR:W 50,100,150"), "OK");
  EXPECT_EQ(bench.ask("?:D"), "S100F1000R50,S200F2000R100,S300F3000R150");
  EXPECT_EQ(bench.ask("B:WS100F1000R100 S200F2000R200 S300F3000R200"), "OK");
  EXPECT_EQ(bench.ask("?:B"), "S100F1000R100,S200F2000R200,S300F3000R200");
}

TEST(SimulatorSettings, RefusesSpeedsOutOfRange) {
  SimulatorBench bench;
  for (const auto* line : {"D:1S0F1000R100", "D:1S1001F1000R100", "D:1S1F1000001R100", "D:1S1F1000R0",
                           "D:1S1F1000R1001", "D:1S1F1000", "D:S1F1000R1", "D:4S1F1000R1", "D:1S1F1000R1X",
                           "DS:1F50001", "DF:1F999", "DR:1 0", "DR:A 50", "D:AS1F1000R1"}) {
    EXPECT_EQ(bench.ask(line), "NG") << line;
  }
  EXPECT_EQ(bench.ask("?:D1"), "S1000F50000R100");
}

TEST(SimulatorSettings, PresetsZeroesAndRestoresTheCounter) {
  SimulatorBench bench;
  EXPECT_EQ(bench.ask("PSET:A+P1000+P2000"), "OK");
  EXPECT_EQ(bench.ask("Q:SP"), "P+1000,P+2000,P+0,1,1,1,R,R,R");
  EXPECT_EQ(bench.ask("PSET:1+P1000000000"), "NG");
  // Manual 64): zeroed at +1000, then moved to +500; RC: shows 1500.
  EXPECT_EQ(bench.ask("R:1"), "OK");
  bench.ask("A:1+P500");
  bench.ask("G:1");
  bench.rest();
  EXPECT_EQ(bench.device.position(1), 500);
  EXPECT_EQ(bench.ask("RC:1"), "OK");
  EXPECT_EQ(bench.device.position(1), 1500);
}

TEST(SimulatorSettings, ChangesWhatAPulseIs) {
  SimulatorBench bench;
  EXPECT_EQ(bench.ask("?:S"), "200,200,200");
  EXPECT_EQ(bench.ask("S:A,100,400"), "OK");
  EXPECT_EQ(bench.ask("?:P"), "20,5,10");
  EXPECT_EQ(bench.ask("M:W+U10+U10+U10"), "OK");
  EXPECT_EQ(bench.ask("?:M"), "500,2000,1000");
  EXPECT_EQ(bench.ask("S:1,7"), "NG");
  EXPECT_EQ(bench.ask("S:W,200"), "NG");
}

TEST(SimulatorSettings, TakesAmountsInEveryUnit) {
  SimulatorBench bench;
  EXPECT_EQ(bench.ask("M:W+U10+N5+M50"), "OK");
  EXPECT_EQ(bench.ask("?:M"), "1000,1,5000000");
  EXPECT_EQ(bench.ask("A:B+P1000+P3000"), "OK");
  EXPECT_EQ(bench.ask("K:D+U1000+P200+M0.3"), "OK");
  EXPECT_EQ(bench.ask("?:K"), "D,100000,200,30000");
  EXPECT_EQ(bench.ask("M:1+D0.01"), "OK");
  EXPECT_EQ(bench.ask("?:M1"), "1000");
  EXPECT_EQ(bench.ask("M:1+P999999999"), "OK");
  EXPECT_EQ(bench.ask("M:1+P1000000000"), "NG");
  EXPECT_EQ(bench.ask("M:1"), "NG");
  EXPECT_EQ(bench.ask("M:A+P1"), "NG");
  EXPECT_EQ(bench.ask("M:1+X5"), "NG");
  EXPECT_EQ(bench.ask("K:1+P5"), "NG");
  EXPECT_EQ(bench.ask("K:W+P5+P5+P5"), "NG");
  EXPECT_EQ(bench.ask("K:A+D1+D1"), "NG");
  EXPECT_EQ(bench.ask("KP:A+D1+D1"), "OK");
}

TEST(SimulatorSettings, SpeedsOfThePrebufferAreInTheUnitOfTheMove) {
  SimulatorBench bench;
  ASSERT_EQ(bench.ask("MP:W+U10+N200+M0.03, S100F1000R50 S200F2000R100 S0.03F0.3R150"), "OK");
  ASSERT_EQ(bench.ask("G:W"), "OK");
  EXPECT_EQ(bench.ask("?:D"), "S10000F100000R50,S20F200R100,S3000F30000R150");
}

TEST(SimulatorSettings, RefusesWhatNeedsExcitationWithoutIt) {
  SimulatorBench bench;
  ASSERT_EQ(bench.ask("C:10"), "OK");
  EXPECT_EQ(bench.ask("?:C"), "0,1,1");
  for (const auto* line :
       {"M:1+P1", "MP:1+P1", "A:1+P1", "AP:1+P1", "K:A+P1+P1", "KP:A+P1+P1", "E:0A0+P1+P1", "EP:0A0+P1+P1", "J:1+",
        "G:1", "G", "GC:1", "H:1", "HRT:1", "Z:1", "ZRT:1", "R:1", "RC:1", "L:1"}) {
    EXPECT_EQ(bench.ask(line), "NG") << line;
  }
  for (const auto* line : {"D:1S100F1000R100", "M:2+P1", "G:2", "L:E", "BEC:1", "C:11"}) {
    EXPECT_EQ(bench.ask(line), "OK") << line;
    bench.rest();
  }
}

TEST(SimulatorSettings, RefusesWhenBusyWhatTheManualSaysSo) {
  SimulatorBench bench;
  bench.ask("J:1+");
  ASSERT_EQ(bench.ask("G:1"), "OK");
  for (const auto* line : {"PSET:1+P1",  "SLEEP:1", "BO:0",      "MODE:MANUAL", "FMT:HIT",   "F:10",  "C:10", "BEEP:0",
                           "S:1,100",    "W:1",     "H:1",       "HRT:1",       "Z:1",       "ZRT:1", "R:1",  "RC:1",
                           "M:1+P1",     "A:1+P1",  "K:A+P1+P1", "E:0A0+P1+P1", "G:1",       "G",     "GC:1", "J:1+",
                           "D:1S1F10R1", "DS:1F1",  "DF:1F2000", "DR:1 1",      "B:1S1F10R1"}) {
    EXPECT_EQ(bench.ask(line), "NG") << line;
  }
  for (const auto* line : {"O:1", "BEC:", "WT:2,1", "WT:1,0", "L:1"}) EXPECT_EQ(bench.ask(line), "OK") << line;
  EXPECT_EQ(bench.ask("MP:1+P1"), "OK");
}

TEST(SimulatorSettings, SwitchesTheController) {
  SimulatorBench bench;
  EXPECT_EQ(bench.ask("BO:0"), "OK");
  EXPECT_EQ(bench.ask("?:BO"), "0");
  EXPECT_EQ(bench.ask("BEEP:0"), "OK");
  EXPECT_EQ(bench.ask("BEEP?"), "0");
  EXPECT_EQ(bench.ask("W:255"), "OK");
  EXPECT_EQ(bench.ask("?:W"), "255");
  EXPECT_EQ(bench.ask("W:2551"), "NG");
  EXPECT_EQ(bench.ask("F:A0"), "OK");
  EXPECT_EQ(bench.ask("?:F"), "0,0,1");
  EXPECT_EQ(bench.ask("SLEEP:1"), "OK");
  EXPECT_EQ(bench.ask("?:SLEEP"), "1");
  EXPECT_EQ(bench.ask("H:1"), "NG");
  EXPECT_EQ(bench.ask("SLEEP:0"), "OK");
  EXPECT_EQ(bench.ask("H:1"), "OK");
}

TEST(SimulatorSettings, OtherModesAnswerFourCommandsOnly) {
  SimulatorBench bench;
  ASSERT_EQ(bench.ask("MODE:MANUAL"), "OK");
  EXPECT_EQ(bench.ask("?:MODE"), "MANUAL");
  EXPECT_EQ(bench.ask("*IDN?"), "SIGMAKOKI,SHRC-203,2106001001,V2.00.000");
  EXPECT_EQ(bench.ask("Q:"), "NG");
  EXPECT_EQ(bench.ask("L:E"), "NG");
  EXPECT_EQ(bench.ask("?:CMD"), "L:E");
  EXPECT_EQ(bench.ask("MODE:NOWHERE"), "NG");
  EXPECT_EQ(bench.ask("MODE:TEACH"), "OK");
  EXPECT_EQ(bench.ask("?:MODE"), "TEACHING");
  EXPECT_EQ(bench.ask("MODE:HOST"), "OK");
  EXPECT_EQ(bench.ask("!:"), "R");
  bench.device.set_mode("REMOTE", bench.now());
  EXPECT_EQ(bench.ask("?:MODE"), "REMOTE");
  EXPECT_EQ(bench.ask("!:"), "NG");
}

TEST(SimulatorSettings, HitFormatHasOtherShapes) {
  SimulatorBench bench;
  bench.ask("M:1+P50000");
  bench.ask("G:1");
  bench.rest();
  ASSERT_EQ(bench.ask("FMT:HIT"), "OK");
  EXPECT_EQ(bench.ask("?:FMT"), "HIT");
  EXPECT_EQ(bench.ask("!:"), "0,0,0");
  EXPECT_EQ(bench.ask("Q:"), "50000,0,0");
  EXPECT_EQ(bench.ask("M:1+P1"), "NG");
  EXPECT_EQ(bench.ask("FMT:SHOT_FC"), "OK");
  EXPECT_EQ(bench.ask("!:"), "R");
}

TEST(SimulatorSettings, ResetForgetsEverythingButThePlace) {
  SimulatorBench bench;
  bench.ask("M:1+P1900000");
  bench.ask("G:1");
  bench.rest();
  bench.ask("D:1S10F20R30");
  bench.ask("MP:1+P5");
  EXPECT_EQ(bench.ask("RESET:"), "OK");
  EXPECT_EQ(bench.wait(999ms), "");
  EXPECT_EQ(bench.ask("Q:"), "");
  EXPECT_EQ(bench.wait(1ms), "");
  EXPECT_EQ(bench.ask("Q:SP"), "P+0,P+0,P+0,1,1,1,R,R,R");
  EXPECT_EQ(bench.ask("?:D1"), "S1000F50000R100");
  EXPECT_EQ(bench.ask("?:MP1"), "NS");
  bench.ask("M:1+P200000");
  bench.ask("G:1");
  bench.rest();
  EXPECT_EQ(bench.device.position(1), 100'000);  // the limit sensor has not moved
}

}  // namespace
}  // namespace axisgate::shrc203::simulator::simulator_settings_test
