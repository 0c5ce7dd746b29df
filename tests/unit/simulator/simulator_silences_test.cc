// Every interpretation of points on which the manual is silent, each shown in what a host sees.
#include <gtest/gtest.h>

#include "tests/unit/simulator/simulator_bench.h"

namespace axisgate::shrc203::simulator::simulator_silences_test {
namespace {

using namespace std::chrono_literals;

// 1000 pulses take one second on every axis.
class Bench : public SimulatorBench {
 public:
  explicit Bench(const Settings& settings = {}, Options options = {}) : SimulatorBench(settings, std::move(options)) {
    ask("D:WS1000F1000R1 S1000F1000R1 S1000F1000R1");
  }
  explicit Bench(std::string_view name, std::string_view value, Options options = {})
      : Bench(Settings{{name, value}}, std::move(options)) {}
};

TEST(SimulatorOptions, TheFirstValueIsTheDefault) {
  for (const OptionName& option : option_names()) {
    EXPECT_EQ(Options().get(option.name), option.values.front()) << option.name;
    EXPECT_GE(option.values.size(), 2u) << option.name;
  }
}

TEST(SimulatorOptions, AreSetByNameAndRefusedWithTheNamesThereAre) {
  Options options;
  EXPECT_TRUE(options.set("busy_scope", "controller"));
  EXPECT_TRUE(options.is("busy_scope", "controller"));
  EXPECT_NE(options.describe().find("busy_scope=controller prebuffer_scope=axis"), std::string::npos);
  const auto unknown = options.set("busy", "axis");
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().message.find("'busy'"), std::string::npos);
  EXPECT_NE(unknown.error().hint.find("busy_scope"), std::string::npos);
  const auto wrong = options.set("busy_scope", "both");
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().hint, "Give one of: axis, controller.");
}

TEST(SimulatorSilences, BusyScope) {
  for (const auto& [value, answer] : Settings{{"axis", "OK"}, {"controller", "NG"}}) {
    Bench bench("busy_scope", value);
    bench.ask("M:1+P1000");
    bench.ask("G:1");
    EXPECT_EQ(bench.ask("M:2+P1000"), answer) << value;
    EXPECT_EQ(bench.ask("D:2S1F1R1"), answer) << value;
    EXPECT_EQ(bench.ask("M:1+P1000"), "NG") << value;
    bench.rest();
    EXPECT_EQ(bench.ask("M:2+P1000"), "OK") << value;
  }
}

TEST(SimulatorSilences, PrebufferScope) {
  for (const auto& [value, registers] : Settings{{"axis", "1000,2000,NS"}, {"controller", "NS,2000,NS"}}) {
    Bench bench("prebuffer_scope", value);
    bench.ask("MP:1+P1000");
    bench.ask("MP:2+P2000");
    EXPECT_EQ(bench.ask("?:MP"), registers) << value;
  }
}

TEST(SimulatorSilences, PrebufferWhileOtherAxisRuns) {
  struct Case {
    std::string_view value, reply, completions;
    std::int64_t position;
  };
  for (const Case& c :
       {Case{"waits_for_go", "OK", "1", 0}, Case{"chains", "OK_D", "1 2", 1000}, Case{"ng", "NG", "1", 0}}) {
    Bench bench("prebuffer_while_other_axis_runs", c.value);
    bench.ask("MP:1+P1000");
    bench.ask("G:1");
    EXPECT_EQ(bench.ask("MP:2+P1000"), c.reply);
    EXPECT_EQ(bench.rest(), c.completions) << c.value;
    EXPECT_EQ(bench.device.position(2), c.position) << c.value;
  }
}

TEST(SimulatorSilences, PrebufferUnderPlainMove) {
  for (const auto& [value, reply] : Settings{{"chains", "OK_D"}, {"waits_for_go", "OK"}}) {
    Bench bench("prebuffer_under_plain_move", value);
    bench.ask("M:1+P1000");
    bench.ask("G:1");
    EXPECT_EQ(bench.ask("MP:1+P500"), reply);
    EXPECT_EQ(bench.rest(), value == "chains" ? "1" : "") << value;
    EXPECT_EQ(bench.device.position(1), value == "chains" ? 1500 : 1000) << value;
  }
}

TEST(SimulatorSilences, GoWithBothBuffers) {
  struct Case {
    std::string_view value, reply, completions;
    std::int64_t position;
  };
  for (const Case& c :
       {Case{"prebuffer_replaces", "OK", "1", 30}, Case{"execution_first", "OK", "1", 530}, Case{"ng", "NG", "", 0}}) {
    Bench bench("go_with_both_buffers", c.value);
    bench.ask("M:1+P500");
    bench.ask("MP:1+P30");
    EXPECT_EQ(bench.ask("G:1"), c.reply) << c.value;
    EXPECT_EQ(bench.rest(), c.completions) << c.value;
    EXPECT_EQ(bench.device.position(1), c.position) << c.value;
  }
}

TEST(SimulatorSilences, ChainStepOn) {
  for (const std::string_view value : {"each_axis", "all_axes_done"}) {
    Bench bench("chain_step_on", value);
    bench.ask("MP:A+P1000+P3000");
    bench.ask("G:A");
    EXPECT_EQ(bench.ask("MP:A+P1000+P1000"), "OK_D");
    EXPECT_EQ(bench.wait(2500ms), value == "each_axis" ? "1 1" : "1") << value;
    EXPECT_EQ(bench.ask("!:AS"), value == "each_axis" ? "R,B" : "B,B") << value;
    bench.rest();
    EXPECT_EQ(bench.elapsed(), 4010ms) << value;
    EXPECT_EQ(bench.device.position(1), 2000);
    EXPECT_EQ(bench.device.position(2), 4000);
  }
}

TEST(SimulatorSilences, InterpolationCompletion) {
  for (const auto& [value, completions] : Settings{{"each_axis_ascending", "2 3"}, {"lowest_axis", "2"}}) {
    Bench bench("interpolation_completion", value);
    bench.ask("KP:C+P300+P400");
    bench.ask("G");
    EXPECT_EQ(bench.rest(), completions) << value;
  }
}

TEST(SimulatorSilences, CompletionAfterStop) {
  for (const auto& [value, completions] : Settings{{"none", ""}, {"sent", "1"}}) {
    Bench bench("completion_after_stop", value);
    bench.ask("MP:1+P1000");
    bench.ask("G:1");
    bench.wait(500ms);
    EXPECT_EQ(bench.ask("L:1"), value == "sent" ? "OK 1" : "OK") << value;
    EXPECT_EQ(bench.rest(), "");
    bench.ask("HRT:1");
    bench.wait(200ms);
    bench.ask("L:");
    EXPECT_EQ(bench.rest(), completions) << value;
  }
}

TEST(SimulatorSilences, CompletionBeforeSettle) {
  for (const auto& [value, at] : std::vector<std::pair<std::string_view, Duration>>{{"yes", 1s}, {"no", 1305ms}}) {
    Bench bench("completion_before_settle", value);
    bench.ask("W:3");
    bench.ask("MP:1+P1000");
    bench.ask("G:1");
    bench.ask("MP:1+P1000");
    bench.wait(1500ms);
    EXPECT_EQ(bench.said().back(), (SimulatorBench::Said{"1", at})) << value;
    EXPECT_EQ(bench.device.position(1), 1195) << value;
  }
}

TEST(SimulatorSilences, WaitCompletion) {
  for (const auto& [value, completions] : Settings{{"none", ""}, {"sent", "1"}}) {
    Bench bench("wait_completion", value);
    bench.ask("WT:1,10");
    bench.ask("G:1");
    EXPECT_EQ(bench.rest(), completions) << value;
    EXPECT_EQ(bench.elapsed(), 1s);
  }
}

TEST(SimulatorSilences, WaitReplyWhileRunning) {
  for (const auto& [value, reply] : Settings{{"ok", "OK"}, {"ok_d", "OK_D"}}) {
    Bench bench("wait_reply_while_running", value);
    EXPECT_EQ(bench.ask("WT:1,10"), "OK");
    bench.ask("G:1");
    EXPECT_EQ(bench.ask("WT:1,10"), reply) << value;
    bench.rest();
    EXPECT_EQ(bench.elapsed(), 2s);
  }
}

TEST(SimulatorSilences, StopKeepsPrebuffer) {
  struct Case {
    std::string_view value, left, after_go, completions;
    std::int64_t position;
  };
  for (const Case& c : {Case{"cleared", "NS", "NG", "", 500}, Case{"kept", "2000", "OK", "1", 2500}}) {
    Bench bench("stop_keeps_prebuffer", c.value);
    bench.ask("MP:1+P1000");
    bench.ask("G:1");
    bench.ask("MP:1+P2000");
    bench.wait(500ms);
    bench.ask("L:1");
    EXPECT_EQ(bench.rest(), "");
    EXPECT_EQ(bench.ask("?:MP1"), c.left) << c.value;
    EXPECT_EQ(bench.ask("G:1"), c.after_go) << c.value;
    EXPECT_EQ(bench.rest(), c.completions) << c.value;
    EXPECT_EQ(bench.device.position(1), c.position) << c.value;
  }
  Bench bench("stop_keeps_prebuffer", "starts_next");
  bench.ask("MP:1+P1000");
  bench.ask("G:1");
  bench.ask("MP:1+P2000");
  bench.wait(500ms);
  bench.ask("L:1");
  EXPECT_EQ(bench.rest(), "1");
  EXPECT_EQ(bench.device.position(1), 2500);
}

TEST(SimulatorSilences, StopWithUnexcitedAxis) {
  for (const auto& [value, reply] : Settings{{"ng_all", "NG"}, {"stops_excited", "OK"}}) {
    Bench bench("stop_with_unexcited_axis", value);
    bench.ask("C:30");
    bench.ask("M:1+P1000");
    bench.ask("G:1");
    bench.wait(500ms);
    EXPECT_EQ(bench.ask("L:W"), reply) << value;
    bench.rest();
    EXPECT_EQ(bench.device.position(1), value == "ng_all" ? 1000 : 500) << value;
    EXPECT_EQ(bench.ask("L:3"), "NG");
  }
}

TEST(SimulatorSilences, EmergencyExcitation) {
  for (const auto& [value, excited] : Settings{{"off", "0,0,0"}, {"on", "1,1,1"}}) {
    Bench bench("emergency_excitation", value);
    bench.ask("L:E");
    bench.ask("BEC:");
    EXPECT_EQ(bench.ask("?:C"), excited) << value;
  }
}

TEST(SimulatorSilences, LimitErrorUntil) {
  for (const auto& [value, status] : Settings{{"bec", "80,R"}, {"next_start", "1,R"}}) {
    Options options;
    options.axes[0].travel_plus_pulses = 10;
    Bench bench("limit_error_until", value, options);
    bench.ask("M:1+P20");
    bench.ask("G:1");
    bench.rest();
    bench.ask("M:1-P5");
    EXPECT_EQ(bench.ask("G:1"), "OK");
    bench.rest();
    EXPECT_EQ(bench.ask("SRQ:1S"), status) << value;
    bench.ask("BEC:1");
    EXPECT_EQ(bench.ask("SRQ:1S"), "1,R") << value;
  }
}

TEST(SimulatorSilences, SpeedWhenUnexcited) {
  for (const auto& [value, reply] : Settings{{"accepted", "OK"}, {"ng", "NG"}}) {
    Bench bench("speed_when_unexcited", value);
    bench.ask("C:10");
    for (const auto* line : {"D:1S1F10R1", "DS:1F2", "DF:1F9000", "DR:1 5", "B:1S1F10R1"}) {
      EXPECT_EQ(bench.ask(line), reply) << value << ' ' << line;
    }
  }
}

TEST(SimulatorSilences, PreviousCommandCountsRefused) {
  for (const auto& [value, previous] : Settings{{"yes", "HELLO"}, {"no", "M:1+P1"}}) {
    Bench bench("previous_command_counts_refused", value);
    bench.ask("M:1+P1");
    bench.ask("HELLO");
    EXPECT_EQ(bench.ask("?:CMD"), previous) << value;
  }
}

TEST(SimulatorSilences, LateGoOrder) {
  for (const auto& [value, lines] : Settings{{"reply_first", "OK 1"}, {"completion_first", "1 OK"}}) {
    Bench bench("late_go_order", value);
    bench.ask("MP:1+P0");
    EXPECT_EQ(bench.ask("G:1"), lines) << value;
    EXPECT_EQ(bench.device.starts(1), 0);
  }
}

TEST(SimulatorSilences, JogSurvivesGc) {
  for (const auto& [value, left] : Settings{{"yes", "+,NS,NS"}, {"no", "NS,NS,NS"}}) {
    Bench bench("jog_survives_gc", value);
    bench.ask("J:1+");
    bench.ask("M:2+P1");
    EXPECT_EQ(bench.ask("GC:"), "OK");
    EXPECT_EQ(bench.ask("?:J"), left) << value;
    EXPECT_EQ(bench.ask("?:M"), "NS,NS,NS") << value;
  }
}

TEST(SimulatorSilences, QSSign) {
  for (const auto& [value, text] :
       Settings{{"plus", "U+0,U-0.2,U+10,1,1,1,R,R,R"}, {"bare", "U0.00,U-0.20,U10.00,1,1,1,R,R,R"}}) {
    Bench bench("q_s_sign", value);
    bench.ask("PSET:W+P0-P20+P1000");
    EXPECT_EQ(bench.ask("Q:S"), text) << value;
  }
  Bench bench("q_s_sign", "bare");
  EXPECT_EQ(bench.ask("Q:SP"), "P0,P0,P0,1,1,1,R,R,R");
}

// A real unit was seen to answer 2, not 3.
TEST(SimulatorSilences, CommandErrorStatus) {
  for (const auto& [value, status] : Settings{{"normal_stays", "3,R"}, {"normal_clears", "2,R"}}) {
    Bench bench("command_error_status", value);
    bench.ask("HELLO");
    EXPECT_EQ(bench.ask("SRQ:1S"), status) << value;
  }
}

TEST(SimulatorSilences, InvalidAxisFields) {
  struct Case {
    std::string_view value, coordinates, status, plain;
  };
  for (const Case& c :
       {Case{"three_fields", "P+0,0,P+0,1,0,1,R,D,R", "1,1,R,R", "+        0,+        0,+        0,K,K,R"},
        Case{"left_out", "P+0,P+0,1,1,R,R", "1,1,R,R", "+        0,+        0,K,K,R"},
        Case{"three_fields_everywhere", "P+0,0,P+0,1,0,1,R,D,R", "1,0,1,R,D,R",
             "+        0,+        0,+        0,K,K,R"}}) {
    Options options;
    options.axis_setting = 4;
    Bench bench("invalid_axis_fields", c.value, options);
    bench.ask("D:1S1F1R1");
    EXPECT_EQ(bench.ask("Q:SP"), c.coordinates) << c.value;
    EXPECT_EQ(bench.ask("SRQ:S"), c.status) << c.value;
    EXPECT_EQ(bench.ask("Q:"), c.plain) << c.value;
  }
}

TEST(SimulatorSilences, FractionOfPulse) {
  struct Case {
    std::string_view value, reply, stored;
  };
  for (const Case& c :
       {Case{"round", "OK", "1,-2,2"}, Case{"truncate", "OK", "0,-1,1"}, Case{"ng", "NG", "NS,NS,NS"}}) {
    Bench bench("fraction_of_pulse", c.value);
    EXPECT_EQ(bench.ask("M:W+N5-N16+P1.5"), c.reply) << c.value;
    EXPECT_EQ(bench.ask("?:M"), c.stored) << c.value;
    EXPECT_EQ(bench.ask("M:1+N10"), "OK") << c.value;
  }
}

// The controller's only prebuffer advances when the whole operation is complete.
TEST(SimulatorSilences, OnePrebufferForAllStepsAsAWhole) {
  Bench bench("prebuffer_scope", "controller");
  bench.ask("MP:A+P1000+P2000");
  bench.ask("G:A");
  EXPECT_EQ(bench.ask("MP:A+P1000+P1000"), "OK_D");
  EXPECT_EQ(bench.wait(1500ms), "1");
  EXPECT_EQ(bench.ask("?:MP"), "1000,1000,NS");
  EXPECT_EQ(bench.wait(1s), "2");
  EXPECT_EQ(bench.rest(), "1 2");
  EXPECT_EQ(bench.elapsed(), 3010ms);
}

}  // namespace
}  // namespace axisgate::shrc203::simulator::simulator_silences_test
