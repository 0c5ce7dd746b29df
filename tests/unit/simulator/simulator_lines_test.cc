// Lines that the simulated SHRC-203 accepts, in every form that clients were seen to send.
#include <gtest/gtest.h>

#include "tests/unit/simulator/simulator_bench.h"

namespace axisgate::shrc203::simulator::simulator_lines_test {
namespace {

using namespace std::string_literals;

TEST(SimulatorLines, TakesEveryTerminator) {
  SimulatorBench bench;
  EXPECT_EQ(bench.send("!:\r\n"), "R");
  EXPECT_EQ(bench.send("!:\r"), "R");
  EXPECT_EQ(bench.send("!:\n"), "R");
  EXPECT_EQ(bench.send("!:"), "");
  EXPECT_EQ(bench.send("\r"), "R");
  EXPECT_EQ(bench.send("\r\n\n  \r\n"), "");
}

TEST(SimulatorLines, TakesSeveralLinesInOneWriteInOrder) {
  SimulatorBench bench;
  EXPECT_EQ(bench.send("M:1+P10\r\nG:1\r\n!:1S\r\n?:CMD\r\n"), "OK OK B !:1S");
}

TEST(SimulatorLines, TakesLooseSpelling) {
  SimulatorBench bench;
  EXPECT_EQ(bench.ask("q:sp"), "P+0,P+0,P+0,1,1,1,R,R,R");
  EXPECT_EQ(bench.ask("* IDN?"), "SIGMAKOKI,SHRC-203,2106001001,V2.00.000");
  EXPECT_EQ(bench.ask("m:1+u100.0"), "OK");
  EXPECT_EQ(bench.ask("?:m1"), "10000");
  EXPECT_EQ(bench.ask("A:1+1000"), "OK");
  EXPECT_EQ(bench.ask("?:A1"), "1000");
  EXPECT_EQ(bench.ask("M:1P7"), "OK");
  EXPECT_EQ(bench.ask("?:M1"), "7");
  EXPECT_EQ(bench.ask("MP:A+P1000+P2000, S100F1000R50 S200F2000R100"), "OK");
  EXPECT_EQ(bench.ask("KP:A+P1000+P200 ,S100F1000R200"), "OK");
  EXPECT_EQ(bench.ask("M:1+P1.0"), "OK");
}

TEST(SimulatorLines, TellsNullAndNonAscii) {
  SimulatorBench bench;
  EXPECT_EQ(bench.send("!:\0\r\n"s), "NG_I");
  EXPECT_EQ(bench.send("\0!:\r\n"s), "NG_I");
  EXPECT_EQ(bench.send("M:1+P1\xff\r\n"), "NG_I");
  EXPECT_EQ(bench.ask("?:M1"), "NS");
  EXPECT_EQ(bench.ask("SRQ:"), "X,K,R");
  EXPECT_EQ(bench.ask("?:CMD"), "SRQ:");
}

TEST(SimulatorLines, RefusesWhatIsNoCommand) {
  SimulatorBench bench;
  for (const auto* line :
       {"X",    "M",   "M:", "?",    "?:",    "!",   "!:4S", "Q",     "Q:1",       "SRQ:1",   "*IDN", "?:WA",
        "?:MX", "L:X", "G1", "H5:1", "MODE:", "T:X", "P:S",  "MS:NO", "PIT:GET,1", "JD:1F10", "?:?"}) {
    EXPECT_EQ(bench.ask(line), "NG") << line;
  }
  EXPECT_EQ(bench.ask(std::string(5000, 'M')), "NG");
  EXPECT_EQ(bench.ask("!:"), "R");
}

TEST(SimulatorLines, ANewHostStartsANewLine) {
  SimulatorBench bench;
  EXPECT_EQ(bench.send("M:1+P"), "");
  bench.device.link_down(bench.now(), "closed");
  bench.device.link_up(bench.now());
  EXPECT_EQ(bench.ask("!:"), "R");
}

TEST(SimulatorLines, RemembersWhatItReceived) {
  SimulatorBench bench;
  bench.send("!:\r\nm:1+p1\n?:X\r");
  EXPECT_EQ(bench.device.received(), (std::vector<std::string>{"!:", "m:1+p1", "?:X"}));
}

}  // namespace
}  // namespace axisgate::shrc203::simulator::simulator_lines_test
