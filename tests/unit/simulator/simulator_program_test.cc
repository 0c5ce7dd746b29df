// Program mode of the simulated SHRC-203 (manual 102) to 116)); the examples are typed by hand.
#include <gtest/gtest.h>

#include "tests/unit/simulator/simulator_bench.h"

namespace axisgate::shrc203::simulator::simulator_program_test {
namespace {

using namespace std::chrono_literals;

TEST(SimulatorProgram, EntersAndLeavesItsModes) {
  SimulatorBench bench;
  EXPECT_EQ(bench.ask("P:R"), "OK");
  EXPECT_EQ(bench.ask("?:MODE"), "HOST,PROGRAM");
  EXPECT_EQ(bench.ask("P:P2"), "OK");
  EXPECT_EQ(bench.ask("P:C1"), "OK");
  EXPECT_EQ(bench.ask("P:T0"), "OK");
  EXPECT_EQ(bench.ask("P:E"), "OK");
  EXPECT_EQ(bench.ask("P:ON"), "OK");
  EXPECT_EQ(bench.ask("?:MODE"), "HOST,PROGRAM");
  EXPECT_EQ(bench.ask("P:OFF"), "OK");
  EXPECT_EQ(bench.ask("?:L"), "2,0,1,0,0,0,0,0,0,0,0,0");
  EXPECT_EQ(bench.ask("P:H"), "OK");
  EXPECT_EQ(bench.ask("?:MODE"), "HOST");
}

TEST(SimulatorProgram, HostModeKnowsNothingButP_R) {
  SimulatorBench bench;
  for (const auto* line : {"P:H", "P:P1", "P:S", "P:O", "P:E", "P:U0", "P:C1", "P:T1", "P:ON", "P:OFF", "P:DEL,1",
                           "P:SET,1,END", "P:GET,1", "P:INIT", "P:", "P:X", "P:R1"}) {
    EXPECT_EQ(bench.ask(line), "NG") << line;
  }
  EXPECT_EQ(bench.ask("J:1+"), "OK");
  EXPECT_EQ(bench.ask("G:1"), "OK");
  EXPECT_EQ(bench.ask("P:R"), "NG");
  EXPECT_EQ(bench.ask("L:1"), "OK");
  bench.rest();
  EXPECT_EQ(bench.ask("P:R"), "OK");
}

TEST(SimulatorProgram, ProgramModeKnowsWhatTheManualLists) {
  SimulatorBench bench;
  ASSERT_EQ(bench.ask("P:R"), "OK");
  for (const auto* line :
       {"P:R",         "M:1+P1",  "G:1",    "G",      "H:1",   "L:",      "L:1",     "D:1S1F1R1", "C:10",
        "O:1",         "I:",      "R:1",    "RESET:", "MS:ON", "FMT:HIT", "SLEEP:1", "P:OFF",     "P:DEL,1",
        "P:SET,1,END", "P:GET,1", "P:INIT", "P:P0",   "P:P9",  "P:C2",    "P:T2",    "P:U0",      "P:U1",
        "P:U2",        "P:S1",    "P:O1",   "P:E1",   "P:ON1", "P:H1"}) {
    EXPECT_EQ(bench.ask(line), "NG") << line;
  }
  EXPECT_EQ(bench.ask("*IDN?"), "SIGMAKOKI,SHRC-203,2106001001,V2.00.000");
  EXPECT_EQ(bench.ask("!:"), "R");
  EXPECT_EQ(bench.ask("!:S"), "R,R,R");
  EXPECT_EQ(bench.ask("Q:"), "+        0,+        0,+        0,X,K,R");
  EXPECT_EQ(bench.ask("?:D1"), "S1000F50000R100");
  EXPECT_EQ(bench.ask("L:E"), "OK");
  EXPECT_EQ(bench.ask("SRQ:"), "K,R,R");
  EXPECT_EQ(bench.ask("BEC:"), "OK");
  EXPECT_EQ(bench.ask("SRQ:S"), "1,1,1,R,R,R");
}

TEST(SimulatorProgram, EditModeKnowsFewerCommands) {
  SimulatorBench bench;
  bench.ask("P:R");
  ASSERT_EQ(bench.ask("P:ON"), "OK");
  for (const auto* line :
       {"!:",    "Q:",      "SRQ:",       "?:L",   "L:E",    "BEC:",     "P:H", "P:P1",    "P:S",
        "P:O",   "P:E",     "P:U0",       "P:C1",  "P:T1",   "P:ON",     "P:R", "P:GET,0", "P:GET,4001",
        "P:GET", "P:DEL,0", "P:DEL,4001", "P:DEL", "P:OFF1", "P:INIT,1", "P:X"}) {
    EXPECT_EQ(bench.ask(line), "NG") << line;
  }
  EXPECT_EQ(bench.ask("*IDN?"), "SIGMAKOKI,SHRC-203,2106001001,V2.00.000");
  EXPECT_EQ(bench.ask("?:MODE"), "HOST,PROGRAM");
  EXPECT_EQ(bench.ask("P:GEL,1"), "END");
  EXPECT_EQ(bench.ask("?:CMD"), "P:GEL,1");
  EXPECT_EQ(bench.ask("MODE:HOST"), "OK");
  EXPECT_EQ(bench.ask("!:"), "R");
}

TEST(SimulatorProgram, StoresTheManualsExamples) {
  SimulatorBench bench;
  bench.ask("P:R");
  bench.ask("P:ON");
  EXPECT_EQ(bench.ask("P:SET:1500,M,1,1,1,100,200,300,0,1,0,0,1,100"), "OK");
  EXPECT_EQ(bench.ask("P:GET,1500"), "M,1,1,1,100,200,300,0,1,0,0,1,100");
  for (const std::string line :
       {"CM,1,0,0,100,0,0,0,1,0,0", "E,1,0,1,0,100,200,0,1,0,0,1,100", "E,1,1,0,2,100,-200,90,0,1,0,0,1,100",
        "E,0,1,1,4,100,150,500,200,0,1,0,0,2,100", "EH,1,1,0,0,0,200,100,1,0,1,0,0,1,100",
        "EH,1,1,0,2,0,200,90,100,0,1,0,0,1,100", "EH,0,1,1,4,-100,50,-150,100,50,0,1,0,0,2,10",
        "PAV,1,1,1,1,2,3,0,1,0,0,1,100", "H,1,1,1,0,0,4", "Z,1,1,1,0,1,0,4", "R,1,1,1", "INPUT,1", "F,1,100", "N,1",
        "END", "NONE"}) {
    EXPECT_EQ(bench.ask("P:SET,1500," + line), "OK") << line;
    EXPECT_EQ(bench.ask("P:GET,1500"), line);
  }
  EXPECT_EQ(bench.ask("P:SET,1500,END"), "OK");
  EXPECT_EQ(bench.ask("P:DEL,1500"), "OK");
  EXPECT_EQ(bench.ask("P:GET,1500"), "NONE");
}

TEST(SimulatorProgram, StoresTheOtherForms) {
  SimulatorBench bench;
  bench.ask("P:R");
  bench.ask("P:ON");
  for (const std::string line :
       {"A,0,0,0,0,0,0,63,4,2560,5", "K,1,1,0,-999999999,999999999,0,0,1,0,6", "M,1,0,0,1,0,0,0,1,0,1,1,10000",
        "M,1,0,0,1,0,0,0,1,0,3,3,-30000", "CA,0,0,1,0,0,5,0,1,0,2", "PAV,1,0,0,20,0,1,0,5", "PAV,1,0,0,20,0,1,0,0,1,2",
        "EH,1,1,0,3,0,200,360000,100,0,1,0,5", "EH,1,1,0,1,0,200,100,1000,0,1,0,4"}) {
    EXPECT_EQ(bench.ask("P:SET,4000," + line), "OK") << line;
    EXPECT_EQ(bench.ask("P:GET,4000"), line);
  }
  EXPECT_EQ(bench.ask("p:set,1, m, 1,0,0, +5,0,0, 0,1,0,5"), "OK");
  EXPECT_EQ(bench.ask("P:GET,1"), "M,1,0,0,5,0,0,0,1,0,5");
}

TEST(SimulatorProgram, RefusesLinesOutOfRange) {
  SimulatorBench bench;
  bench.ask("P:R");
  bench.ask("P:ON");
  for (const std::string line : {"",
                                 "X",
                                 "M",
                                 "M,2,0,0,1,0,0,0,1,0,5",
                                 "M,1,0,0,1000000000,0,0,0,1,0,5",
                                 "M,1,0,0,1,0,0,64,1,0,5",
                                 "M,1,0,0,1,0,0,0,0,0,5",
                                 "M,1,0,0,1,0,0,0,5,0,5",
                                 "M,1,0,0,1,0,0,0,1,2561,5",
                                 "M,1,0,0,1,0,0,0,1,0,7",
                                 "M,1,0,0,1,0,0,0,1,0,0",
                                 "M,1,0,0,1,0,0,0,1,0,5,1,100",
                                 "M,1,0,0,1,0,0,0,1,0,0,4,100",
                                 "M,1,0,0,1,0,0,0,1,0,0,1,1",
                                 "M,1,0,0,1,0,0,0,1,0,0,1,30001",
                                 "M,1,0,0,1,0,0,0,1,0,1,2,100",
                                 "M,1,0,0,1,0,0,0,1,0,1,1,10001",
                                 "M,1,0,0,1,0,0,0,1,0",
                                 "K,1,0,0,1,0,0,0,1,0,5",
                                 "CM,1,1,0,1,1,0,0,1,0,0",
                                 "CM,1,0,0,1,0,0,0,1,0,1",
                                 "CM,1,0,0,1,0,0,0,1,0,4",
                                 "E,1,1,1,0,100,200,0,1,0,5",
                                 "E,1,0,0,0,100,200,0,1,0,5",
                                 "E,1,1,0,6,100,200,0,1,0,5",
                                 "E,1,1,0,2,100,200,361,0,1,0,5",
                                 "E,1,1,0,4,100,100,200,200,0,1,0,5",
                                 "EH,1,1,0,0,0,200,100,1001,0,1,0,5",
                                 "EH,1,1,0,0,0,200,100,0,1,0,5",
                                 "PAV,1,1,1,21,0,1,0,5",
                                 "H,1,1,1,0,0,0",
                                 "H,1,1,1,0,1,0,4",
                                 "Z,1,1,1,0,0,4",
                                 "R,1,1",
                                 "R,1,1,1,1",
                                 "INPUT,64",
                                 "INPUT,-1",
                                 "F,0,1",
                                 "F,10,1",
                                 "F,1,0",
                                 "F,1,65536",
                                 "F,1",
                                 "N,0",
                                 "N,10",
                                 "END,1",
                                 "NONE,1",
                                 "M,1,0,0,,0,0,0,1,0,5"}) {
    EXPECT_EQ(bench.ask("P:SET,7," + line), "NG") << line;
  }
  EXPECT_EQ(bench.ask("P:SET,0,END"), "NG");
  EXPECT_EQ(bench.ask("P:SET,4001,END"), "NG");
  EXPECT_EQ(bench.ask("P:SET7,END"), "NG");
  EXPECT_EQ(bench.ask("P:GET,7"), "NONE");
}

TEST(SimulatorProgram, AddsTheMissingEnd) {
  SimulatorBench bench;
  bench.ask("P:R");
  bench.ask("P:ON");
  EXPECT_EQ(bench.ask("P:SET,1,R,1,0,0"), "OK");
  EXPECT_EQ(bench.ask("P:SET,30,INPUT,1"), "OK");
  EXPECT_EQ(bench.ask("P:OFF"), "OK");
  EXPECT_EQ(bench.ask("P:ON"), "OK");
  EXPECT_EQ(bench.ask("P:GET,31"), "END");
  EXPECT_EQ(bench.ask("P:SET,31,N,1"), "OK");
  EXPECT_EQ(bench.ask("P:SET,4000,N,1"), "OK");
  EXPECT_EQ(bench.ask("P:OFF"), "OK");
  EXPECT_EQ(bench.ask("P:ON"), "OK");
  EXPECT_EQ(bench.ask("P:GET,4000"), "N,1");
  EXPECT_EQ(bench.ask("P:INIT"), "OK");
  EXPECT_EQ(bench.ask("P:GET,1"), "END");
  EXPECT_EQ(bench.ask("P:GET,4000"), "NONE");
}

TEST(SimulatorProgram, KeepsEightProgramsOverAPowerCycle) {
  SimulatorBench bench;
  bench.ask("P:R");
  for (const std::string number : {"1", "8"}) {
    ASSERT_EQ(bench.ask("P:P" + number), "OK");
    ASSERT_EQ(bench.ask("P:ON"), "OK");
    ASSERT_EQ(bench.ask("P:SET,2,INPUT," + number), "OK");
    ASSERT_EQ(bench.ask("P:OFF"), "OK");
  }
  ASSERT_EQ(bench.ask("P:ON"), "OK");
  ASSERT_EQ(bench.ask("P:SET,2,INPUT,63"), "OK");
  bench.device.power_cycle(bench.now());
  bench.wait(2s);
  EXPECT_EQ(bench.ask("?:MODE"), "HOST");
  EXPECT_EQ(bench.ask("?:L"), "1,0,1,0,0,0,0,0,0,0,0,0");
  ASSERT_EQ(bench.ask("P:R"), "OK");
  for (const std::string number : {"1", "8"}) {
    ASSERT_EQ(bench.ask("P:P" + number), "OK");
    ASSERT_EQ(bench.ask("P:ON"), "OK");
    EXPECT_EQ(bench.ask("P:GET,2"), "INPUT," + number);
    ASSERT_EQ(bench.ask("P:OFF"), "OK");
  }
}

}  // namespace
}  // namespace axisgate::shrc203::simulator::simulator_program_test
