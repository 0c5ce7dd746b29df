// Answers of the simulated SHRC-203, typed from the manual's formats and examples.
#include <gtest/gtest.h>

#include "tests/unit/simulator/simulator_bench.h"

namespace axisgate::shrc203::simulator::simulator_questions_test {
namespace {

using namespace std::chrono_literals;

Options two_axes() {
  Options options;
  options.axis_setting = 3;
  return options;
}

TEST(SimulatorQuestions, IdentifiesItselfAsTheManualsExample) {
  SimulatorBench bench;
  EXPECT_EQ(bench.ask("*IDN?"), "SIGMAKOKI,SHRC-203,2106001001,V2.00.000");
  EXPECT_EQ(bench.ask("?:V"), "V2.00.000");
  EXPECT_EQ(bench.ask("?:N"), "SHRC-203");
  EXPECT_EQ(bench.ask("?:SN"), "2106001001");
  EXPECT_EQ(bench.ask("?:AXIS"), "6");
  EXPECT_EQ(bench.ask("?:MODE"), "HOST");
  EXPECT_EQ(bench.ask("?:FMT"), "SHOT_FC");
}

TEST(SimulatorQuestions, StartsAsItsUsersWereTold) {
  SimulatorBench bench;
  EXPECT_EQ(bench.ask("?:D"), "S1000F50000R100,S1000F50000R100,S1000F50000R100");
  EXPECT_EQ(bench.ask("?:P"), "10,10,10");
  EXPECT_EQ(bench.ask("?:C"), "1,1,1");
  EXPECT_EQ(bench.ask("?:ACS"), "0,0,0");
  EXPECT_EQ(bench.ask("?:W"), "0");
  EXPECT_EQ(bench.ask("?:SLEEP"), "0");
  EXPECT_EQ(bench.ask("?:BO"), "1");
  EXPECT_EQ(bench.ask("?:BEEP"), "1");
  EXPECT_EQ(bench.ask("?:O"), "0");
  EXPECT_EQ(bench.ask("I:"), "0");
  EXPECT_EQ(bench.ask("?:AN"), "1,2,3");
  EXPECT_EQ(bench.ask("Q:"), "+        0,+        0,+        0,K,K,R");
  EXPECT_EQ(bench.ask("Q:S"), "U+0,U+0,U+0,1,1,1,R,R,R");
}

TEST(SimulatorQuestions, TellsPositioningOfAllOrSomeAxes) {
  SimulatorBench bench;
  EXPECT_EQ(bench.ask("!:"), "R");
  EXPECT_EQ(bench.ask("!:S"), "R,R,R");
  EXPECT_EQ(bench.ask("!:1S"), "R");
  EXPECT_EQ(bench.ask("!:AS"), "R,R");
  EXPECT_EQ(bench.ask("!S"), "R,R,R");
  EXPECT_EQ(bench.ask("!1S"), "R");
  EXPECT_EQ(bench.ask("!AS"), "R,R");
  EXPECT_EQ(bench.ask("!WS"), "R,R,R");
  EXPECT_EQ(bench.ask("SRQ:"), "K,K,R");
  EXPECT_EQ(bench.ask("SRQ:1S"), "1,R");
  EXPECT_EQ(bench.ask("SRQ:AS"), "1,1,R,R");
  EXPECT_EQ(bench.ask("SRQ:S"), "1,1,1,R,R,R");
  bench.ask("M:2+P100");
  bench.ask("G:2");
  EXPECT_EQ(bench.ask("!:"), "B");
  EXPECT_EQ(bench.ask("!:S"), "R,B,R");
  EXPECT_EQ(bench.ask("SRQ:S"), "1,1,1,R,B,R");
  EXPECT_EQ(bench.ask("SRQ:"), "K,K,B");
}

TEST(SimulatorQuestions, WritesCoordinatesInTenCharacters) {
  SimulatorBench bench;
  bench.ask("PSET:W+P200-P200+P100000");
  EXPECT_EQ(bench.ask("Q:"), "+      200,-      200,+   100000,K,K,R");
  EXPECT_EQ(bench.ask("Q:").size(), 38u);
}

TEST(SimulatorQuestions, TellsACounterBeyondNineDigits) {
  SimulatorBench bench;
  bench.ask("PSET:1+P999999999");
  bench.ask("M:1+P10");
  bench.ask("G:1");
  bench.rest();
  EXPECT_EQ(bench.ask("Q:"), "+999999999,+        0,+        0,K,R,R");
  EXPECT_EQ(bench.ask("SRQ:1S"), "100,R");  // bit 9
}

TEST(SimulatorQuestions, WritesCoordinatesInTheUnitAskedFor) {
  SimulatorBench bench;
  bench.ask("PSET:W-P100000+P200000+P300000");
  EXPECT_EQ(bench.ask("Q:SM"), "M-1,M+2,M+3,1,1,1,R,R,R");
  EXPECT_EQ(bench.ask("Q:SUC"), "U-1000,U+2000,U+3000,1,1,1,R,R,R");
  EXPECT_EQ(bench.ask("Q:SPE"), "P-100000,P+200000,P+300000,1,1,1,R,R,R");
  EXPECT_EQ(bench.ask("Q:SN"), "N-1000000,N+2000000,N+3000000,1,1,1,R,R,R");
  EXPECT_EQ(bench.ask("Q:SD"), "D-1,D+2,D+3,1,1,1,R,R,R");
  EXPECT_EQ(bench.ask("Q:SC"), "U-1000,U+2000,U+3000,1,1,1,R,R,R");
  EXPECT_EQ(bench.ask("Q:SX"), "NG");
}

TEST(SimulatorQuestions, LeavesOutUncontrollableAxes) {
  SimulatorBench bench({}, two_axes());
  EXPECT_EQ(bench.ask("?:AXIS"), "3");
  EXPECT_EQ(bench.ask("!S"), "R,R");
  EXPECT_EQ(bench.ask("SRQ:S"), "1,1,R,R");
  EXPECT_EQ(bench.ask("?:M"), "NS,NS");
  EXPECT_EQ(bench.ask("?:P"), "10,10");
  EXPECT_EQ(bench.ask("Q:SP"), "P+0,P+0,0,1,1,0,R,R,D");
  EXPECT_EQ(bench.ask("!:3S"), "NG");
  EXPECT_EQ(bench.ask("M:B+P1+P1"), "NG");
  EXPECT_EQ(bench.ask("M:W+P1+P1"), "OK");
}

TEST(SimulatorQuestions, ShowsSpeedsByPartAndUnit) {
  SimulatorBench bench;
  ASSERT_EQ(bench.ask("D:WS100F1000R100 S200F2000R200 S300F3000R300"), "OK");
  EXPECT_EQ(bench.ask("?:D"), "S100F1000R100,S200F2000R200,S300F3000R300");
  EXPECT_EQ(bench.ask("?:D1"), "S100F1000R100");
  EXPECT_EQ(bench.ask("?:DA"), "S100F1000R100,S200F2000R200");
  EXPECT_EQ(bench.ask("?:DS"), "100,200,300");
  EXPECT_EQ(bench.ask("?:DF1"), "1000");
  EXPECT_EQ(bench.ask("?:DSA"), "100,200");
  EXPECT_EQ(bench.ask("?:DF2,U"), "20");
  EXPECT_EQ(bench.ask("?:DS,M"), "0.001,0.002,0.003");
  EXPECT_EQ(bench.ask("?:DR"), "100,200,300");
  EXPECT_EQ(bench.ask("?:DRA"), "100,200");
  EXPECT_EQ(bench.ask("?:DS1,X"), "NG");
}

TEST(SimulatorQuestions, ShowsTheExecutionBuffer) {
  SimulatorBench bench;
  EXPECT_EQ(bench.ask("?:M"), "NS,NS,NS");
  EXPECT_EQ(bench.ask("?:M1"), "NS");
  EXPECT_EQ(bench.ask("?:K"), "NS");
  bench.ask("M:W+P1000+P2000-P3000");
  EXPECT_EQ(bench.ask("?:M"), "1000,2000,-3000");
  EXPECT_EQ(bench.ask("?:M1"), "1000");
  EXPECT_EQ(bench.ask("?:MA"), "1000,2000");
  EXPECT_EQ(bench.ask("?:M1,M"), "0.01");
  EXPECT_EQ(bench.ask("?:M,U"), "10,20,-30");
  bench.ask("A:1+P1000");
  EXPECT_EQ(bench.ask("?:A"), "1000,NS,NS");
  EXPECT_EQ(bench.ask("?:M"), "NS,2000,-3000");
  bench.ask("K:D+P1000+P2000+P3000");
  EXPECT_EQ(bench.ask("?:K"), "D,1000,2000,3000");
  EXPECT_EQ(bench.ask("?:K,M"), "D,0.01,0.02,0.03");
  EXPECT_EQ(bench.ask("?:M"), "NS,NS,NS");
  EXPECT_EQ(bench.ask("J:B+-"), "OK");
  EXPECT_EQ(bench.ask("?:J"), "+,NS,-");
  EXPECT_EQ(bench.ask("?J:1"), "+");
  EXPECT_EQ(bench.ask("?:K"), "NS");
}

TEST(SimulatorQuestions, ShowsThePrebuffer) {
  SimulatorBench bench;
  EXPECT_EQ(bench.ask("?:MP"), "NS,NS,NS");
  bench.ask("MP:A+P1000+P2000");
  EXPECT_EQ(bench.ask("?:MP"), "1000,2000,NS");
  EXPECT_EQ(bench.ask("?:MP1,M"), "0.01");
  bench.ask("AP:1+P1000");
  EXPECT_EQ(bench.ask("?:APA"), "1000,NS");
  bench.ask("WT:A,10,20");
  EXPECT_EQ(bench.ask("?:WTA"), "10,20");
  EXPECT_EQ(bench.ask("?:WT"), "10,20,NS");
  bench.ask("WI:W,63,63,63");
  EXPECT_EQ(bench.ask("?:WI"), "63,63,63");
  EXPECT_EQ(bench.ask("?:WI1"), "63");
  bench.ask("KP:A+P1000+P2000");
  EXPECT_EQ(bench.ask("?:KP"), "A,1000,2000");
  EXPECT_EQ(bench.ask("?:WI"), "NS,NS,63");
}

TEST(SimulatorQuestions, ShowsArcsAsTheyWereSet) {
  SimulatorBench bench;
  EXPECT_EQ(bench.ask("?:E"), "NS");
  EXPECT_EQ(bench.ask("E:0A0M0.05-M0.05"), "OK");
  EXPECT_EQ(bench.ask("?:E"), "0,A,0,5000,-5000");
  EXPECT_EQ(bench.ask("?:E,M"), "0,A,0,0.05,-0.05");
  EXPECT_EQ(bench.ask("E:1B0+P100-P200D90"), "OK");
  EXPECT_EQ(bench.ask("?:E"), "1,B,0,100,-200,90");
  EXPECT_EQ(bench.ask("E:2A0+M0.05+M0.03+M0.08+M0.12"), "OK");
  EXPECT_EQ(bench.ask("?:E"), "2,A,0,5000,3000,8000,12000");
  EXPECT_EQ(bench.ask("E:3A0N1+P0+P5000+P2000"), "OK");
  EXPECT_EQ(bench.ask("?:E"), "3,A,0,1,0,5000,2000");
  EXPECT_EQ(bench.ask("E:4A0+P0+P100D90+P50"), "OK");
  EXPECT_EQ(bench.ask("?:E"), "4,A,0,0,100,90,50");
  EXPECT_EQ(bench.ask("EP:5A0+P100+P100+P200+P0+P300,S100F1000R50"), "OK");
  EXPECT_EQ(bench.ask("?:EP"), "5,A,0,100,100,200,0,300");
  EXPECT_EQ(bench.ask("EP:1B0+P100-200D90,S100F1000R50"), "OK");
  EXPECT_EQ(bench.ask("?:EP"), "1,B,0,100,-200,90");
}

TEST(SimulatorQuestions, RefusesImpossibleArcs) {
  SimulatorBench bench;
  EXPECT_EQ(bench.ask("E:2A0+P10+P10+P20+P20"), "NG");
  EXPECT_EQ(bench.ask("E:1A0+P10+P10D0"), "NG");
  EXPECT_EQ(bench.ask("E:1A0+P10+P10D360.1"), "NG");
  EXPECT_EQ(bench.ask("E:3B0N1+P0+P5000+P2000"), "NG");
  EXPECT_EQ(bench.ask("E:0W0+P10+P10"), "NG");
  EXPECT_EQ(bench.ask("E:0A2+P10+P10"), "NG");
}

// Manual 40): the answer is the previous line, as it was sent.
TEST(SimulatorQuestions, RepeatsTheLineBefore) {
  SimulatorBench bench;
  EXPECT_EQ(bench.ask("?:CMD"), "NS");
  bench.ask("WI:W,C");
  EXPECT_EQ(bench.ask("?:CMD"), "WI:W,C");
  EXPECT_EQ(bench.ask("?:CMD"), "?:CMD");
  bench.ask("m:1+p10");
  EXPECT_EQ(bench.ask("?:CMD"), "m:1+p10");
}

TEST(SimulatorQuestions, MarksARefusedCommandUntilOneIsAccepted) {
  SimulatorBench bench;
  EXPECT_EQ(bench.ask("HELLO"), "NG");
  EXPECT_EQ(bench.ask("Q:"), "+        0,+        0,+        0,X,K,R");
  EXPECT_EQ(bench.ask("SRQ:"), "X,K,R");
  EXPECT_EQ(bench.ask("SRQ:1S"), "3,R");
  EXPECT_EQ(bench.ask("M:1+P10"), "OK");
  EXPECT_EQ(bench.ask("SRQ:"), "K,K,R");
  EXPECT_EQ(bench.ask("?:NONSENSE"), "NG");
  EXPECT_EQ(bench.ask("SRQ:"), "X,K,R");
}

TEST(SimulatorQuestions, TellsInputsAndOutputs) {
  SimulatorBench bench;
  bench.device.set_inputs(16);
  EXPECT_EQ(bench.ask("I:"), "16");
  EXPECT_EQ(bench.ask("O:32"), "OK");
  EXPECT_EQ(bench.ask("?:O"), "32");
  EXPECT_EQ(bench.ask("O:64"), "NG");
}

}  // namespace
}  // namespace axisgate::shrc203::simulator::simulator_questions_test
