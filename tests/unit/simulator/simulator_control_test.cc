// Actions of a person at the simulated device, as lines of text.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "device/core/control_language.h"
#include "tests/paths/paths.h"
#include "tests/unit/simulator/simulator_bench.h"

namespace axisgate::shrc203::simulator::simulator_control_test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class SimulatorControl : public testing::Test {
 protected:
  std::string say(std::string_view line) { return control_reply(bench.device.operate(line, bench.now())); }

  // Returns the status of axis 1 in hexadecimal (manual 7) SRQ:S), and R or B for READY or BUSY.
  std::string status() { return bench.ask("SRQ:1S"); }

  std::vector<std::string> usages() {
    std::vector<std::string> found;
    std::istringstream list(say("help").substr(3));
    for (std::string usage; std::getline(list >> std::ws, usage, ';');) found.push_back(usage);
    return found;
  }

  SimulatorBench bench;
};

TEST_F(SimulatorControl, HelpListsEveryCommandAndTellsEachOne) {
  EXPECT_THAT(say("help"), StartsWith("ok help [COMMAND]; mode HOST|MANUAL|"));
  EXPECT_THAT(usages(), testing::SizeIs(18));
  EXPECT_EQ(say("help limit"),
            "ok limit AXIS cw|ccw on|off (AXIS 1 to 3): a limit sensor (manual 5), bits 20, 21); on stops what moves "
            "into it");
  for (const std::string& usage : usages()) {
    const std::string name(words_of(usage).front());
    EXPECT_THAT(say("help " + name), AllOf(StartsWith("ok " + usage), HasSubstr(": "))) << name;
  }
  EXPECT_THAT(say("help me"), StartsWith("error: there is no command 'me'; say one of: help, mode, "));
}

TEST_F(SimulatorControl, TheReadmeHasEveryUsage) {
  std::ifstream file(paths::in_project("device/shrc203/simulator/README.md"));
  std::ostringstream readme;
  readme << file.rdbuf();
  for (const std::string& usage : usages()) EXPECT_THAT(readme.str(), HasSubstr("\n    " + usage + "\n"));
}

// Tries every usage with each value of its choices.
TEST_F(SimulatorControl, EveryUsageCanBeSaid) {
  for (const std::string& usage : usages()) {
    std::vector<std::string> lines = {""};
    for (const std::string_view place : words_of(usage)) {
      std::vector<std::string> longer;
      const std::string choices = place == "AXIS" || place == "[AXIS]"      ? "1|2|3"
                                  : place == "[COMMAND]"                    ? "help"
                                  : place == "MILLISECONDS"                 ? "0|60000"
                                  : place == "NUMBER" || place == "SECONDS" ? "0|63"
                                                                            : std::string(place);
      for (const std::string& line : lines) {
        std::istringstream each(choices);
        for (std::string choice; std::getline(each, choice, '|');) longer.push_back(line + choice + " ");
      }
      lines = longer;
    }
    for (const std::string& line : lines) EXPECT_THAT(say(line), StartsWith("ok")) << line;
  }
}

TEST_F(SimulatorControl, ARefusalSaysWhatIsAllowed) {
  const std::string one_of = "; say one of: help, mode, dialect, ";
  const std::string limit = "; say: limit AXIS cw|ccw on|off (AXIS 1 to 3)";
  EXPECT_THAT(say("jump"), StartsWith("error: there is no command 'jump'" + one_of));
  EXPECT_THAT(say(""), StartsWith("error: the line is empty" + one_of));
  EXPECT_THAT(say(" \t "), StartsWith("error: the line is empty" + one_of));
  EXPECT_EQ(say("limit"), "error: AXIS is missing" + limit);
  EXPECT_EQ(say("limit 1 cw"), "error: on|off is missing" + limit);
  EXPECT_EQ(say("limit 4 cw on"), "error: '4' cannot be used as AXIS" + limit);
  EXPECT_EQ(say("limit 1 up on"), "error: 'up' cannot be used as cw|ccw" + limit);
  EXPECT_EQ(say("limit 1 cw on now"), "error: 'now' is too much" + limit);
  EXPECT_EQ(say("power"), "error: cycle is missing; say: power cycle");
  EXPECT_EQ(say("power off"), "error: 'off' cannot be used as cycle; say: power cycle");
  EXPECT_EQ(say("inputs 64"), "error: '64' cannot be used as NUMBER; say: inputs NUMBER (NUMBER 0 to 63)");
}

TEST_F(SimulatorControl, NumbersAreReadWholeOrNotAtAll) {
  for (const char* number : {"-1", "64", "1.5", "1x", "x", "0x1", "+1", "1e1", "99999999999999999999"}) {
    EXPECT_THAT(say(std::string("inputs ") + number), StartsWith("error: ")) << number;
  }
  for (const char* number : {"-0.1", "3600.1", "nan", "inf", "1e1", "1s", "1,5", "0x1", "1e999"}) {
    EXPECT_THAT(say(std::string("stuck ") + number), StartsWith("error: ")) << number;
  }
  for (const char* line : {"delay 60001", "delay 0.5", "delay -1"}) EXPECT_THAT(say(line), StartsWith("error: "));
}

TEST_F(SimulatorControl, WhatIsRefusedChangesNothing) {
  EXPECT_EQ(bench.send("M:1+P50000\r\nG:1\r\n"), "OK OK");
  bench.wait(seconds(1));
  for (const char* line :
       {"emergency now", "excitation 1", "excitation 1 maybe", "excitation 0 off", "limit 1 cw on on", "error 1 scale",
        "flag 1 near 1", "mode", "mode HOST,MS", "dialect", "dialect HAT", "power", "power cycle 2", "unplug",
        "unplug 1 2", "stuck soon", "delay", "sleep", "inputs 100"}) {
    EXPECT_THAT(say(line), StartsWith("error: ")) << line;
  }
  EXPECT_EQ(status(), "1,B");
  EXPECT_EQ(bench.ask("?:MODE"), "HOST");
  EXPECT_EQ(bench.ask("?:FMT"), "SHOT_FC");
  EXPECT_EQ(bench.ask("?:C"), "1,1,1");
  EXPECT_EQ(bench.ask("I:"), "0");
}

TEST_F(SimulatorControl, ALineMayBe200CharactersLongAndOfAnyBytes) {
  const std::string blanks(kControlLineMax - 4, ' ');
  EXPECT_EQ(say(blanks + "busy"), "ok no no no");
  EXPECT_THAT(say(blanks + " busy"), StartsWith("error: the line is longer than 200 characters; say one of: help"));
  EXPECT_THAT(say("\x1b[2J\xff'\n"), StartsWith("error: there is no command '\\x1B[2J\\xFF'\\n'; say"));
  EXPECT_THAT(say(std::string(200, 'x')), AllOf(HasSubstr("xxx...'"), testing::Not(HasSubstr(std::string(81, 'x')))));
  EXPECT_THAT(say(std::string("emergency\0", 10)), StartsWith("error: there is no command 'emergency\\x00'"));
  EXPECT_EQ(say("  LIMIT\t1  Cw ON "), "ok");
  EXPECT_EQ(say("mode manual"), "ok");
  EXPECT_EQ(bench.ask("?:MODE"), "MANUAL");
}

TEST_F(SimulatorControl, ModeAndDialect) {
  for (const char* mode : {"MANUAL", "REMOTE", "TEACHING", "EDIT", "TEST", "HOST"}) {
    EXPECT_EQ(say(std::string("mode ") + mode), "ok");
    EXPECT_EQ(bench.ask("?:MODE"), mode);
  }
  EXPECT_EQ(say("dialect HIT"), "ok");
  EXPECT_EQ(bench.ask("?:FMT"), "HIT");
  EXPECT_EQ(say("dialect SHOT_FC"), "ok");
  EXPECT_EQ(bench.ask("?:FMT"), "SHOT_FC");
}

// Manual 66): bit 6 of the status is 20 in hexadecimal, and the motors are off.
TEST_F(SimulatorControl, EmergencyAndExcitation) {
  EXPECT_EQ(bench.send("M:1+P50000\r\nG:1\r\n"), "OK OK");
  EXPECT_EQ(say("emergency"), "ok");
  EXPECT_EQ(status(), "20,R");
  EXPECT_EQ(bench.ask("?:C"), "0,0,0");
  EXPECT_EQ(bench.ask("BEC:"), "OK");
  for (const char* axis : {"1", "2", "3"}) EXPECT_EQ(say(std::string("excitation ") + axis + " on"), "ok");
  EXPECT_EQ(bench.ask("?:C"), "1,1,1");
  EXPECT_EQ(bench.send("M:2+P50000\r\nG:2\r\n"), "OK OK");
  EXPECT_EQ(say("excitation 2 off"), "ok");
  bench.rest();
  EXPECT_EQ(say("position 2"), "ok 0");
  EXPECT_EQ(bench.ask("?:C"), "1,0,1");
}

// Manual 5): bits 20 and 21 are 80000 and 100000, the limit error's bit 8 is 80.
TEST_F(SimulatorControl, LimitSensors) {
  EXPECT_EQ(say("limit 1 cw on"), "ok");
  EXPECT_EQ(status(), "80001,R");
  EXPECT_EQ(say("limit 1 ccw on"), "ok");
  EXPECT_EQ(say("limit 1 cw off"), "ok");
  EXPECT_EQ(status(), "100001,R");
  EXPECT_EQ(bench.send("M:1-P10\r\nG:1\r\n"), "OK OK");
  bench.rest();
  EXPECT_EQ(status(), "100080,R");
  EXPECT_EQ(say("position"), "ok 0 0 0");
}

// Manual 5): bits 3, 4, 5, 7, 13 and 15. Each error stops the axis, and so does S9, which has no bit.
TEST_F(SimulatorControl, ErrorsStopTheAxis) {
  struct Case {
    std::string name;
    std::string status;
  };
  for (const Case& raised : {Case{"scale", "4"},
                             {"disconnection", "8"},
                             {"overflow", "10"},
                             {"hunting", "40"},
                             {"system", "1000"},
                             {"overheat", "4000"},
                             {"s9", "0"}}) {
    EXPECT_EQ(bench.send("M:1+P500\r\nG:1\r\n"), "OK OK");
    EXPECT_EQ(say("error 1 " + raised.name + " on"), "ok");
    bench.rest();
    EXPECT_EQ(status(), raised.status + ",R");
    EXPECT_EQ(bench.ask("SRQ:"), "K,R,R") << "an error stop (manual 6) SRQ:)";
    EXPECT_EQ(say("position 1"), "ok 0");
    EXPECT_EQ(bench.ask("M:1+P1"), "NG");
    EXPECT_EQ(bench.ask("SRQ:2S"), "3,R") << "that of axis 2 is normal; the line before was refused";
    EXPECT_EQ(bench.ask("BEC:1"), "OK");
    EXPECT_EQ(status(), raised.name == "overflow" ? "1,R" : raised.status + ",R") << "manual 53)";
    EXPECT_EQ(say("error 1 " + raised.name + " off"), "ok");
    EXPECT_EQ(status(), "1,R");
  }
}

// Manual 5): bits 10, 11, 12, 14, 16, 22, 23 and 24, in addition to "normal".
TEST_F(SimulatorControl, FlagsShowInTheStatus) {
  struct Case {
    std::string name;
    std::string status;
  };
  for (const Case& raised : {Case{"config", "201"},
                             {"io_overload", "401"},
                             {"power_overload", "801"},
                             {"heat", "2001"},
                             {"out_of_position", "8001"},
                             {"cw_software_limit", "200001"},
                             {"ccw_software_limit", "400001"},
                             {"near", "800001"}}) {
    EXPECT_EQ(say("flag 1 " + raised.name + " on"), "ok");
    EXPECT_EQ(status(), raised.status + ",R");
    EXPECT_EQ(bench.ask("SRQ:"), "K,K,R");
    EXPECT_EQ(bench.ask("M:1+P1"), "OK");
    EXPECT_EQ(say("flag 1 " + raised.name + " off"), "ok");
    EXPECT_EQ(status(), "1,R");
  }
}

TEST_F(SimulatorControl, FlagsOfAnAxisThatMoves) {
  EXPECT_EQ(bench.send("MP:1+P50000\r\nG:1\r\n"), "OK OK");
  bench.wait(milliseconds(500));
  EXPECT_EQ(say("flag 1 out_of_position on"), "ok");
  EXPECT_EQ(status(), "10001,B") << "bit 17 while BUSY";
  EXPECT_EQ(say("flag 1 heat on"), "ok");
  EXPECT_EQ(status(), "12001,B") << "a warning stops nothing";
  const std::string before = say("position 1");
  EXPECT_EQ(say("flag 1 cw_software_limit on"), "ok");
  EXPECT_EQ(bench.rest(), "") << "stopped, as by L:";
  EXPECT_EQ(say("position 1"), before);
  EXPECT_EQ(status(), "20A001,R");
}

// Manual 32): E if CONFIG is on and could not be read.
TEST_F(SimulatorControl, ConfigErrorShowsInAcs) {
  EXPECT_EQ(say("flag 2 config on"), "ok");
  EXPECT_EQ(bench.ask("?:ACS"), "0,0,0");
  EXPECT_EQ(bench.send("MS:ON\r\nMS:SET,3,10,1\r\nMS:OFF\r\n"), "OK OK OK");
  EXPECT_EQ(say("power cycle"), "ok");
  bench.wait(seconds(1));
  EXPECT_EQ(bench.ask("?:ACS"), "0,E,0");
  EXPECT_EQ(say("flag 2 config off"), "ok");
  EXPECT_EQ(bench.ask("?:ACS"), "0,1,0");
}

TEST_F(SimulatorControl, InputsOutputsTriggers) {
  EXPECT_EQ(say("inputs 21"), "ok");
  EXPECT_EQ(bench.ask("I:"), "21");
  EXPECT_EQ(bench.ask("O:42"), "OK");
  EXPECT_EQ(say("outputs"), "ok 42");
  EXPECT_EQ(say("triggers"), "ok 0");
  EXPECT_EQ(bench.ask("T:M"), "OK");
  EXPECT_EQ(say("triggers"), "ok 1");
}

TEST_F(SimulatorControl, SleepOnlyAtRest) {
  EXPECT_EQ(bench.send("M:1+P500\r\nG:1\r\n"), "OK OK");
  EXPECT_EQ(say("busy"), "ok yes no no");
  EXPECT_EQ(
      say("sleep on"),
      "error: an axis is BUSY, and it falls asleep or wakes only while stationary; wait until `busy` says no, or stop "
      "it");
  bench.rest();
  EXPECT_EQ(say("busy 1"), "ok no");
  EXPECT_EQ(say("sleep on"), "ok");
  EXPECT_EQ(bench.ask("?:SLEEP"), "1");
  EXPECT_EQ(say("sleep off"), "ok");
  EXPECT_EQ(bench.ask("?:SLEEP"), "0");
}

TEST_F(SimulatorControl, PowerCycle) {
  EXPECT_EQ(bench.send("M:1+P500\r\nG:1\r\n"), "OK OK");
  bench.rest();
  EXPECT_EQ(say("position"), "ok 500 0 0");
  EXPECT_EQ(say("power cycle"), "ok");
  EXPECT_EQ(bench.ask("*IDN?"), "") << "it boots";
  bench.wait(seconds(1));
  EXPECT_EQ(say("position"), "ok 0 0 0");
  EXPECT_EQ(bench.ask("?:N"), "SHRC-203");
}

// Bytes are lost in both directions: sent lines, a completion, and the end of half a line.
TEST_F(SimulatorControl, Unplugged) {
  EXPECT_EQ(bench.send("MP:1+P50\r\nG:1\r\n"), "OK OK");
  EXPECT_EQ(say("unplug 2.5"), "ok");
  EXPECT_EQ(bench.ask("M:2+P1"), "");
  EXPECT_EQ(bench.wait(milliseconds(2499)), "");
  EXPECT_EQ(say("position 1"), "ok 50") << "it went on";
  EXPECT_EQ(bench.ask("?:N"), "");
  EXPECT_EQ(bench.wait(milliseconds(1)), "");
  EXPECT_EQ(bench.ask("?:M2"), "NS");
  EXPECT_EQ(bench.device.received().size(), 3u);
  EXPECT_EQ(say("unplug 3600"), "ok");
  EXPECT_EQ(bench.ask("?:N"), "");
  EXPECT_EQ(say("unplug 0"), "ok");
  EXPECT_EQ(bench.ask("?:N"), "SHRC-203");
}

TEST_F(SimulatorControl, DelayAndStuck) {
  EXPECT_EQ(say("delay 100"), "ok");
  EXPECT_EQ(bench.ask("?:N"), "");
  EXPECT_EQ(bench.wait(milliseconds(99)), "");
  EXPECT_EQ(bench.wait(milliseconds(1)), "SHRC-203");
  EXPECT_EQ(say("delay 0"), "ok");
  EXPECT_EQ(say("stuck 0.25"), "ok");
  EXPECT_EQ(bench.ask("?:N"), "");
  EXPECT_EQ(bench.wait(milliseconds(249)), "");
  EXPECT_EQ(bench.wait(milliseconds(1)), "SHRC-203");
  EXPECT_EQ(say("stuck 3600"), "ok");
  EXPECT_EQ(bench.ask("?:SN"), "");
  EXPECT_EQ(say("stuck 0"), "ok");
  EXPECT_EQ(bench.wait({}), "2106001001");
}

// Values are those of the given time, not of the last byte on the line.
TEST_F(SimulatorControl, LooksAtTheTimeGiven) {
  EXPECT_EQ(bench.send("M:1+P50000\r\nG:1\r\n"), "OK OK");
  const TimePoint later = bench.now() + seconds(10);
  EXPECT_EQ(bench.device.operate("position 1", later).value(), "50000");
  EXPECT_EQ(bench.device.operate("busy 1", later).value(), "no");
}

// Reasons are for callers that offer the same actions by other means than text.
TEST_F(SimulatorControl, RefusalsHaveReasons) {
  const auto refused = bench.device.operate("limit 9 cw on", bench.now());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().reason, Reason::invalid_request);
  EXPECT_EQ(bench.send("M:1+P500\r\nG:1\r\n"), "OK OK");
  EXPECT_EQ(bench.device.operate("sleep on", bench.now()).error().reason, Reason::axis_busy);
  EXPECT_EQ(bench.device.operate("emergency", bench.now()).value(), "");
}

}  // namespace
}  // namespace axisgate::shrc203::simulator::simulator_control_test
