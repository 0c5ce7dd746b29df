// Settings as lines, and answers as settings. Lines are typed from manual 45) to 64), 90) to 101), answers from 9) to
// 42).
#include "device/shrc203/command/setting_lines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

namespace axisgate::shrc203::setting_lines_test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::IsEmpty;
using Target = Trigger::Target;

State state_at(std::int64_t minimum, std::int64_t maximum) {
  State state;
  for (AxisState& axis : state.axes) {
    axis.controllable = true;
    axis.minimum_speed = minimum;
    axis.maximum_speed = maximum;
  }
  return state;
}

std::vector<std::string> sent(const Setting& setting, const State& state = state_at(1000, 50'000)) {
  const auto lines = lines_for(setting, state);
  EXPECT_TRUE(lines) << lines.error().message;
  return lines.value_or(std::vector<std::string>());
}

Reason refusal(const Setting& setting) {
  const auto lines = lines_for(setting, state_at(1000, 50'000));
  EXPECT_FALSE(lines);
  return lines ? Reason::unspecified : lines.error().reason;
}

TEST(SettingLines, OfAnAxis) {
  EXPECT_THAT(sent(SetClosedLoop{1, true}), ElementsAre("F:10"));
  EXPECT_THAT(sent(SetClosedLoop{2, false}), ElementsAre("F:21"));
  EXPECT_THAT(sent(SetExcitation{3, false}), ElementsAre("C:30"));
  EXPECT_THAT(sent(SetExcitation{1, true}), ElementsAre("C:11"));
  EXPECT_THAT(sent(SetDivisions{2, 100}), ElementsAre("S:2,100"));
  EXPECT_EQ(refusal(SetDivisions{2, 7}), Reason::out_of_range);
  EXPECT_THAT(sent(SetOriginSpeeds{1, {500, 5000, 200}}), ElementsAre("B:1S500F5000R200"));
  EXPECT_EQ(refusal(SetOriginSpeeds{1, {500, 5000, 1001}}), Reason::out_of_range);
}

TEST(SettingLines, OfTheController) {
  EXPECT_THAT(sent(SetDisplay{true}), ElementsAre("BO:1"));
  EXPECT_THAT(sent(SetBeep{false}), ElementsAre("BEEP:0"));
  EXPECT_THAT(sent(SetOutputs{5}), ElementsAre("O:5"));
  EXPECT_EQ(refusal(SetOutputs{64}), Reason::out_of_range);
  EXPECT_THAT(sent(SetSleep{true}), ElementsAre("SLEEP:1"));
  EXPECT_THAT(sent(SetMode{"manual"}), ElementsAre("MODE:MANUAL"));
  EXPECT_THAT(sent(SetFormat{"shot_fc"}), ElementsAre("FMT:SHOT_FC"));
  EXPECT_THAT(sent(FireTrigger{}), ElementsAre("T:M"));
  EXPECT_THAT(sent(ResetController{}), ElementsAre("RESET:"));
}

TEST(SettingLines, OnlyTheSpeedsThatAreGivenAreSent) {
  EXPECT_THAT(sent(SetSpeeds{1, 2000, {}, {}}), ElementsAre("DS:1F2000"));
  EXPECT_THAT(sent(SetSpeeds{1, {}, 20'000, {}}), ElementsAre("DF:1F20000"));
  EXPECT_THAT(sent(SetSpeeds{2, {}, {}, 250}), ElementsAre("DR:2 250"));
  EXPECT_THAT(sent(SetSpeeds{2, 2000, 20'000, 250}), ElementsAre("DS:2F2000", "DF:2F20000", "DR:2 250"));
  EXPECT_THAT(sent(SetSpeeds{2, {}, {}, {}}), IsEmpty());
}

TEST(SettingLines, TheLowestSpeedNeverExceedsTheHighest) {
  EXPECT_THAT(sent(SetSpeeds{1, 60'000, 90'000, {}}), ElementsAre("DF:1F90000", "DS:1F60000"));
  EXPECT_THAT(sent(SetSpeeds{1, 200, 400, {}}), ElementsAre("DS:1F200", "DF:1F400"));
  EXPECT_THAT(sent(SetSpeeds{1, {}, 400, {}}), ElementsAre("DS:1F400", "DF:1F400"));
  const auto crossed = lines_for(SetSpeeds{1, 500, 400, {}}, state_at(1000, 50'000));
  ASSERT_FALSE(crossed);
  EXPECT_EQ(crossed.error().reason, Reason::out_of_range);
  EXPECT_EQ(crossed.error().message, "axis 1: the lowest speed S of 500 pulses/s exceeds the highest, F of 400");
  EXPECT_EQ(crossed.error().axis, 1);
  EXPECT_EQ(refusal(SetSpeeds{1, {}, 1'000'001, {}}), Reason::out_of_range);
  EXPECT_EQ(refusal(SetSpeeds{1, {}, {}, -5}), Reason::out_of_range);
}

TEST(SettingLines, SettlingIsInTenthsOfASecond) {
  EXPECT_THAT(sent(SetSettling{milliseconds(2500)}), ElementsAre("W:25"));
  EXPECT_THAT(sent(SetSettling{seconds(255)}), ElementsAre("W:2550"));
  EXPECT_THAT(sent(SetSettling{}), ElementsAre("W:0"));
  EXPECT_EQ(refusal(SetSettling{milliseconds(250)}), Reason::not_representable);
  EXPECT_EQ(refusal(SetSettling{milliseconds(255'100)}), Reason::out_of_range);
  EXPECT_EQ(refusal(SetSettling{Duration(-1)}), Reason::out_of_range);
}

TEST(SettingLines, OfTheTrigger) {
  EXPECT_THAT(sent(SetTrigger{}), ElementsAre("T:S"));
  EXPECT_THAT(sent(SetTrigger{{Target::timer, 0, 100}}), ElementsAre("T:T100"));
  EXPECT_THAT(sent(SetTrigger{{Target::drive_pulses, 2, 500}}), ElementsAre("T:P2P500"));
  EXPECT_THAT(sent(SetTrigger{{Target::scale_plus, 1, 2}}), ElementsAre("T:E1P+2"));
  EXPECT_THAT(sent(SetTrigger{{Target::scale_minus, 1, 2}}), ElementsAre("T:E1P-2"));
  EXPECT_EQ(refusal(SetTrigger{{Target::drive_pulses, 0, 500}}), Reason::out_of_range);
  EXPECT_EQ(refusal(SetTrigger{{Target::timer, 0, 0}}), Reason::out_of_range);
}

TEST(SettingLines, OfCoordinates) {
  EXPECT_THAT(sent(SetCoordinates{{{1, 1000}}}), ElementsAre("PSET:1+P1000"));
  EXPECT_THAT(sent(SetCoordinates{{{1, 0}, {3, -200}}}), ElementsAre("PSET:B+P0-P200"));
  EXPECT_THAT(sent(SetOrigin{AxisSet::first(3)}), ElementsAre("R:D"));
  EXPECT_THAT(sent(UnsetOrigin{AxisSet::of(2)}), ElementsAre("RC:2"));
}

Settings told(std::string_view question, std::string_view answer, AxisSet controllable = AxisSet::first(3)) {
  Settings settings;
  read_setting(question, answer, controllable, settings);
  return settings;
}

TEST(SettingAnswers, OfAxes) {
  Settings settings;
  const auto read = [&](std::string_view question, std::string_view answer) {
    read_setting(question, answer, AxisSet::first(3), settings);
  };
  read("?:D", "S100F1000R50,S200F2000R60,S300F3000R70");
  read("?:B", "S10F100R5,S20F200R6,S30F300R7");
  read("?:S", "2,100,8000");
  read("?:F", "0,1,0");
  read("?:C", "1,1,0");
  read("?:AN", "X,2,3");
  read("?:R", "10,10,0.5");
  ASSERT_EQ(settings.axes.size(), 3u);
  const AxisSettings& third = settings.axes.at(3);
  EXPECT_EQ(third.speeds, (SpeedSetting{300, 3000, 70}));
  EXPECT_EQ(third.origin_speeds, (SpeedSetting{30, 300, 7}));
  EXPECT_EQ(third.divisions, 8000);
  EXPECT_EQ(third.closed_loop, true);
  EXPECT_EQ(third.excited, false);
  EXPECT_EQ(third.name_on_device, "3");
  EXPECT_EQ(third.scale_resolution, "0.5");
  EXPECT_EQ(settings.axes.at(2).closed_loop, false);
  EXPECT_EQ(settings.axes.at(1).name_on_device, "X");
}

TEST(SettingAnswers, OfControllableAxesOnly) {
  AxisSet two = AxisSet::of(1);
  two.add(3);
  for (const char* answer : {"2,100", "2,1,100"}) {
    const Settings settings = told("?:S", answer, two);
    ASSERT_EQ(settings.axes.size(), 2u) << answer;
    EXPECT_EQ(settings.axes.at(1).divisions, 2) << answer;
    EXPECT_EQ(settings.axes.at(3).divisions, 100) << answer;
  }
}

TEST(SettingAnswers, OfTheController) {
  EXPECT_EQ(told("?:W", "25").settling, milliseconds(2500));
  EXPECT_EQ(told("?:SLEEP", "1").sleeping, true);
  EXPECT_EQ(told("?:BO", "0").display_lit, false);
  EXPECT_EQ(told("?:BEEP", "1").beep, true);
  EXPECT_EQ(told("?:O", "5").outputs, 5);
  EXPECT_EQ(told("I:", "63").inputs, 63);
  EXPECT_EQ(told("?:T", "0,1,1000").trigger, (Trigger{Target::drive_pulses, 1, 1000}));
  EXPECT_EQ(told("?:T", "NS").trigger, Trigger{});
  EXPECT_EQ(told("?:FMT", "SHOT_FC").format, "SHOT_FC");
  EXPECT_EQ(told("?:MODE", "HOST").mode, "HOST");
}

TEST(SettingAnswers, WhatIsNoneOfItsKindChangesNothing) {
  EXPECT_EQ(told("?:W", "NG").settling, std::nullopt);
  EXPECT_EQ(told("?:O", "64").outputs, std::nullopt);
  EXPECT_EQ(told("?:MODE", "S100").mode, std::nullopt);
  EXPECT_THAT(told("?:S", "2,x,100").axes, IsEmpty());
}

TEST(SettingAnswers, ToWhatIsAskedInThisOrder) {
  EXPECT_THAT(setting_questions(), ElementsAre("?:D", "?:B", "?:S", "?:F", "?:C", "?:AN", "?:R", "?:W", "?:BO",
                                               "?:BEEP", "?:O", "I:", "?:T", "?:SLEEP", "?:FMT", "?:MODE"));
}

}  // namespace
}  // namespace axisgate::shrc203::setting_lines_test
