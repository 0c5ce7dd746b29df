// Lines that the gateway itself sends, as the manual writes them.
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "device/shrc203/command/builders.h"
#include "device/shrc203/command/command_table.h"

namespace axisgate::shrc203::command_builders_test {
namespace {

using commands::Question;
using commands::Saved;

const AxisSet kFirst = AxisSet::of(1);
const AxisSet kTwo = AxisSet::of(1) | AxisSet::of(2);
const commands::Speeds kSpeeds = {{1, {100, 1000, 100}}, {2, {200, 2000, 200}}};

TEST(CommandBuilders, QuestionsOfTheState) {
  EXPECT_EQ(commands::ask(Question::identity).line, "*IDN?");          // 1)
  EXPECT_EQ(commands::ask(Question::ready).line, "!:");                // 2)
  EXPECT_EQ(commands::ask(Question::each_ready).line, "!:S");          // 3)
  EXPECT_EQ(commands::ask(Question::positions).line, "Q:SPC");         // 5)
  EXPECT_EQ(commands::ask(Question::scale_counters).line, "Q:SPE");    // 5)
  EXPECT_EQ(commands::ask(Question::excitation).line, "?:C");          // 33)
  EXPECT_EQ(commands::ask(Question::sleep).line, "?:SLEEP");           // 35)
  EXPECT_EQ(commands::ask(Question::mode).line, "?:MODE");             // 37)
  EXPECT_EQ(commands::ask(Question::format).line, "?:FMT");            // 38)
  EXPECT_EQ(commands::ask(Question::previous_command).line, "?:CMD");  // 40)
  EXPECT_EQ(commands::ask(Question::program).line, "?:L");             // 41)
  EXPECT_EQ(commands::ask(Question::inputs).line, "I:");               // 95)
}

TEST(CommandBuilders, QuestionsOfSettings) {
  EXPECT_EQ(commands::ask(Question::scale_resolution).line, "?:R");  // 9)
  EXPECT_EQ(commands::ask(Question::pulse_length).line, "?:P");      // 10)
  EXPECT_EQ(commands::ask(Question::speeds).line, "?:D");            // 13)
  EXPECT_EQ(commands::ask(Question::origin_speeds).line, "?:B");     // 17)
  EXPECT_EQ(commands::ask(Question::outputs).line, "?:O");           // 26)
  EXPECT_EQ(commands::ask(Question::auto_config).line, "?:ACS");     // 32)
  EXPECT_EQ(commands::ask(Question::trigger).line, "?:T");           // 42)
  EXPECT_EQ(commands::ask(Question::serial_number).line, "?:SN");    // 43)
  EXPECT_EQ(commands::ask(Question::axes).line, "?:AXIS");           // 44)
}

// Manual 18) to 25), 28), 29), 31).
TEST(CommandBuilders, WhatTellsOfARegister) {
  const std::pair<Register, const char*> lines[] = {
      {Register::m, "?:M"},   {Register::mp, "?:MP"}, {Register::a, "?:A"}, {Register::ap, "?:AP"},
      {Register::e, "?:E"},   {Register::ep, "?:EP"}, {Register::k, "?:K"}, {Register::kp, "?:KP"},
      {Register::wt, "?:WT"}, {Register::wi, "?:WI"}, {Register::j, "?:J"},
  };
  for (const auto& [reg, line] : lines) EXPECT_EQ(commands::ask(commands::question_of(reg)).line, line);
}

TEST(CommandBuilders, AQuestionIsAskedByItsText) {
  for (int place = 0; place <= static_cast<int>(Question::axes); ++place) {
    const auto question = static_cast<Question>(place);
    const Command asked = commands::ask(question);
    EXPECT_EQ(asked.line, commands::text(question));
    EXPECT_EQ(asked.row, &commands::row_of(question));
    EXPECT_EQ(asked.row->effect, Effect::question) << asked.line;
  }
}

TEST(CommandBuilders, Setpoints) {
  EXPECT_EQ(commands::set_setpoint(Register::m, {{1, 1000}, {2, 2000}}).line, "M:A+P1000+P2000");   // 67)
  EXPECT_EQ(commands::set_setpoint(Register::a, {{1, 1000}, {3, -3000}}).line, "A:B+P1000-P3000");  // 69)
  EXPECT_EQ(commands::set_setpoint(Register::k, {{1, 1000}, {2, 200}}).line, "K:A+P1000+P200");     // 83)
  EXPECT_EQ(commands::set_setpoint(Register::mp, {{1, 1000}}).line, "MP:1+P1000");                  // 68)
  EXPECT_EQ(commands::set_setpoint(Register::ap, {{1, 10}, {2, 20}}, kSpeeds).line,                 // 70)
            "AP:A+P10+P20,S100F1000R100 S200F2000R200");
  EXPECT_EQ(commands::set_setpoint(Register::kp, {{1, 10}, {2, 20}}, {{1, {100, 1000, 100}}}).line,  // 84)
            "KP:A+P10+P20,S100F1000R100");
  EXPECT_EQ(commands::set_jog({{1, 1}, {2, -1}}).line, "J:A+-");                       // 88)
  EXPECT_EQ(commands::set_jog_speeds({{1, 1000}, {2, 2000}}).line, "JD:AF1000F2000");  // 93)
  EXPECT_EQ(commands::clear_setpoints(kTwo).line, "GC:A");                             // 87)
  EXPECT_EQ(commands::setter_of(Register::wi).name, "WI:");                            // 58)
}

// Manual 77) to 82).
TEST(CommandBuilders, CurvesByTheirForm) {
  const auto place = [](Arguments& arguments, const char* letter, const char* pulses) {
    arguments.add("m", "+").add("u", "P").add(letter, pulses);
  };
  Arguments circle = Arguments().axes(kTwo).add("d", "0");
  Arguments helix = Arguments().axes(kTwo).add("d", "1").add("n", "2");
  for (Arguments* arguments : {&circle, &helix}) {
    place(*arguments, "c1", "100");
    place(*arguments, "c2", "200");
  }
  place(helix, "z", "50");
  EXPECT_EQ(commands::set_curve(CurveForm::circle, circle)->line, "EP:0A0+P100+P200");
  EXPECT_EQ(commands::set_curve(CurveForm::helix_of_turns, helix)->line, "EP:3A1N2+P100+P200+P50");
  Arguments arc = circle;
  arc.add("ae", "400");
  EXPECT_EQ(commands::set_curve(CurveForm::arc_by_angle, arc).error().reason, Reason::out_of_range);
  for (const CommandRow& row : model().commands()) {
    const bool curve = row.reg == Register::e || row.reg == Register::ep;
    ASSERT_EQ(row.curve.has_value(), curve) << row.name;
    if (!curve) continue;
    EXPECT_EQ(row.name.back(), '0' + static_cast<int>(*row.curve)) << row.name;
  }
}

TEST(CommandBuilders, StartsAndStops) {
  EXPECT_EQ(commands::go(kTwo).line, "G:A");                                    // 86)
  EXPECT_EQ(commands::home(kFirst).line, "HRT:1");                              // 60)
  EXPECT_EQ(commands::return_to_origin(kTwo).line, "ZRT:A");                    // 62)
  EXPECT_EQ(commands::stop(kFirst).line, "L:1");                                // 65)
  EXPECT_EQ(commands::emergency_stop().line, "L:E");                            // 66)
  EXPECT_EQ(commands::go_to_saved(Saved::place, "3").line, "PIT:GRT,3");        // 131)
  EXPECT_EQ(commands::go_to_saved(Saved::coordinates, "3").line, "PAV:GRT,3");  // 136)
  EXPECT_EQ(commands::ask_saved(Saved::place, "3").line, "PIT:GET,3");          // 129)
  EXPECT_EQ(commands::ask_saved(Saved::coordinates, "3").line, "PAV:GET,3");    // 134)
}

TEST(CommandBuilders, Settings) {
  EXPECT_EQ(commands::set_speeds(kSpeeds).line, "D:AS100F1000R100 S200F2000R200");         // 89)
  EXPECT_EQ(commands::set_origin_speeds(kSpeeds).line, "B:AS100F1000R100 S200F2000R200");  // 94)
  EXPECT_EQ(commands::set_outputs(63).line, "O:63");                                       // 96)
  EXPECT_EQ(commands::clear_errors(kTwo).line, "BEC:A");                                   // 53)
}

// Manual 89): S is at most F, and both are 1 to 1,000,000.
TEST(CommandBuilders, SpeedsThatCanBeSet) {
  EXPECT_TRUE(commands::can_be_set({1, 1'000'000, 1000}));
  EXPECT_FALSE(commands::can_be_set({0, 1000, 100}));
  EXPECT_FALSE(commands::can_be_set({1001, 1000, 100}));
  EXPECT_FALSE(commands::can_be_set({100, 1'000'001, 100}));
  EXPECT_FALSE(commands::can_be_set({100, 1000, 1001}));
}

TEST(CommandBuilders, TheWayBackToHost) {
  EXPECT_EQ(commands::stop_program().line, "P:E");             // 107)
  EXPECT_EQ(commands::leave_program_mode().line, "P:H");       // 103)
  EXPECT_EQ(commands::leave_program_edit().line, "P:OFF");     // 112)
  EXPECT_EQ(commands::leave_switches().line, "MS:OFF");        // 118)
  EXPECT_EQ(commands::ask_all_switches(6).line, "MS:GETK,6");  // 124)
}

}  // namespace
}  // namespace axisgate::shrc203::command_builders_test
