// Tests of commands, settings, saved positions and tokens, and of their log entries.
#include <gtest/gtest.h>

#include "server/api/request/audit.h"
#include "server/api/stage/position_checks.h"
#include "server/api/stage/setting_lines.h"
#include "tests/api/ask.h"
#include "tests/api/log.h"

namespace axisgate::api {
namespace {

using std::chrono::minutes;

TEST(Audit, WhoMadeAndRevokedATokenIsInTheLog) {
  World world;
  Call call = World::by(kAdmin);
  Log log;
  call.validate_only = true;
  ASSERT_TRUE(world.api->tokens.create(call, NewToken{.name = "scan"}));
  EXPECT_EQ(log.text(), "");
  call.validate_only = false;
  const auto made = world.api->tokens.create(call, NewToken{.name = "scan"});
  ASSERT_TRUE(made && *made);
  EXPECT_TRUE((*made)->secret.starts_with("axisgate.scan."));
  EXPECT_FALSE(world.api->tokens.revoke(call, "other"));
  ASSERT_TRUE(world.api->tokens.revoke(call, "scan"));
  EXPECT_EQ(log.text(), "unix root made the token scan (operator)\nunix root revoked the token scan\n");
}

TEST(Audit, NothingOfWhatIsNotAudited) {
  Log log;
  audit(RequestKind::list_tokens, kAdmin, "looked");
  EXPECT_EQ(log.text(), "");
  audit(RequestKind::create_token, kAdmin, "looked");
  EXPECT_EQ(log.text(), "unix root looked\n");
}

TEST(TokensOfApi, LiveFor90DaysOrAsAsked) {
  World world;
  const auto life = [&](std::optional<std::chrono::seconds> asked) {
    const auto made = world.api->tokens.create(World::by(kAdmin), NewToken{.name = "t", .life = asked});
    (void)world.api->tokens.revoke(World::by(kAdmin), "t");
    return made ? (*made)->token.expires - (*made)->token.created : std::chrono::seconds(0);
  };
  EXPECT_EQ(life({}), std::chrono::days(90));
  EXPECT_EQ(life(minutes(5)), minutes(5));
  EXPECT_EQ(life(std::chrono::seconds::max()), std::chrono::seconds(0));
  EXPECT_EQ(life(std::chrono::seconds(-1)), std::chrono::seconds(0));
}

class CommandsOfApi : public ::testing::Test {
 protected:
  std::string refusal(Transaction transaction, const std::string& who = kAnna) {
    const auto opened = world_.api->commands.execute(World::by(who), kDevice, std::move(transaction));
    return opened ? "" : std::string(name(opened.error().reason)) + ": " + opened.error().message;
  }
  World world_;
};

TEST_F(CommandsOfApi, ATransactionIsBounded) {
  EXPECT_EQ(refusal({}), "INVALID_REQUEST: a transaction has 1 to 100 lines, not 0");
  EXPECT_EQ(refusal({std::vector<std::string>(101, "L:1")}),
            "INVALID_REQUEST: a transaction has 1 to 100 lines, not 101");
  EXPECT_EQ(refusal({{"L:1", std::string(257, 'x')}}), "MALFORMED_LINE: line 2 is longer than 256 characters");
  EXPECT_EQ(refusal({{"L:1"}, minutes(11)}), "OUT_OF_RANGE: timeout is not above 0 and at most 10 minutes");
  EXPECT_EQ(refusal({{"L:1"}, Duration()}), "OUT_OF_RANGE: timeout is not above 0 and at most 10 minutes");
  EXPECT_EQ(refusal({std::vector<std::string>(100, std::string(256, 'x')), minutes(10)}), "");
}

TEST_F(CommandsOfApi, SomeLinesAreForAdministrators) {
  EXPECT_EQ(refusal({{"L:1", "reset:"}}),
            "NOT_ALLOWED: only an administrator may send this command, and unix anna is operator");
  EXPECT_EQ(refusal({{"L:1", "reset:"}}, kAdmin), "");
}

// AnySetting is a kind of device that accepts any setting, with one line for each.
class AnySetting final : public stage::Kind {
 public:
  std::string_view name() const override { return "any"; }
  int axis_count() const override { return 3; }
  std::span<const stage::KindSetting> settings() const override { return {}; }
  std::unique_ptr<stage::StageController> make_controller(const stage::Profile&, const Words&, ByteLink&,
                                                          stage::EventSink&, use::Permission&) const override {
    return nullptr;
  }
  Result<void> check_lines(const std::vector<std::string>&) const override { return {}; }
  Result<void> check_option(std::string_view, std::string_view) const override { return {}; }
  std::unique_ptr<Simulation> make_simulation(const Words&, ByteLink&) const override { return nullptr; }
  Result<std::vector<std::string>> lines_for(const stage::Setting& setting, const stage::State&) const override {
    if (const auto* coordinates = std::get_if<stage::SetCoordinates>(&setting)) {
      std::string text = "coordinates";
      for (const auto& [axis, pulses] : coordinates->pulses)
        text += " " + std::to_string(axis) + ":" + std::to_string(pulses);
      return std::vector{text};
    }
    if (const auto* speeds = std::get_if<stage::SetOriginSpeeds>(&setting)) {
      return std::vector{"origin " + std::to_string(speeds->speeds.minimum) + " " +
                         std::to_string(speeds->speeds.maximum) + " " + std::to_string(speeds->speeds.acceleration_ms)};
    }
    return std::vector{"setting " + std::to_string(setting.index())};
  }
};

class SettingLines : public ::testing::Test {
 protected:
  SettingLines() {
    for (const int axis : {1, 2}) {
      state_.axis(axis).controllable = true;
      state_.axis(axis).scale = Scale{};
    }
  }
  template <class Wanted>
  std::string lines(const Wanted& wanted) {
    const Result<Lines> all = lines_of(wanted, kind_, state_);
    if (!all) return std::string(name(all.error().reason)) + ": " + all.error().message;
    std::string text;
    for (const std::string& line : *all) text += (text.empty() ? "" : ", ") + line;
    return text;
  }
  const AnySetting kind_;
  stage::State state_;
};

TEST_F(SettingLines, InTheOrderOfTheManual) {
  EXPECT_EQ(lines(SettingsChange{.axes = {{.axis = 2, .closed_loop = true, .excited = true}}, .beep = false}),
            "setting 0, setting 1, setting 6");
  EXPECT_EQ(lines(SettingsChange{}), "INVALID_REQUEST: nothing is to be changed");
}

TEST_F(SettingLines, SomeAreChangedAlone) {
  EXPECT_EQ(lines(SettingsChange{.mode = "HOST"}), "setting 11");
  for (const SettingsChange& wanted :
       {SettingsChange{.beep = true, .mode = "HOST"}, SettingsChange{.beep = true, .format = "HIT"},
        SettingsChange{.axes = {{.axis = 1, .excited = true, .divisions = 2}}}}) {
    EXPECT_EQ(lines(wanted), "INVALID_REQUEST: divisions, mode and format are changed alone");
  }
}

TEST_F(SettingLines, AnAxisThatThereIsOnce) {
  const auto excited = [](int axis) { return AxisChange{.axis = axis, .excited = true}; };
  EXPECT_EQ(lines(SettingsChange{.axes = {excited(3)}}), "UNKNOWN_AXIS: axis 3 cannot be moved here");
  EXPECT_EQ(lines(SettingsChange{.axes = {excited(1), excited(1)}}), "INVALID_REQUEST: axis 1 is named twice");
  state_.axis(1).scale.reset();
  EXPECT_EQ(lines(SettingsChange{.axes = {excited(1)}}), "LINK_DOWN: the resolution of axis 1 is not known yet");
}

TEST_F(SettingLines, WhatCannotBeChanged) {
  EXPECT_EQ(lines(SettingsChange{.axes = {{.axis = 1, .names_given = true}}}),
            "INVALID_REQUEST: name_on_device and scale_resolution cannot be changed here");
  EXPECT_EQ(lines(SettingsChange{.inputs_given = true}), "INVALID_REQUEST: inputs are set by what is wired to them");
}

TEST_F(SettingLines, OriginSpeedsAreCompletedFromTheAxis) {
  const SettingsChange faster{.axes = {{.axis = 1, .origin_speeds = Speeds{.maximum = pulses(900)}}}};
  EXPECT_EQ(lines(faster), "INVALID_REQUEST: axis 1: the axis's present minimum speed S is not known yet");
  state_.axis(1).origin_speeds = stage::SpeedSetting{100, 500, 20};
  EXPECT_EQ(lines(faster), "origin 100 900 20");
  const SettingsChange slower{.axes = {{.axis = 1, .origin_speeds = Speeds{.maximum = pulses(50)}}}};
  EXPECT_EQ(lines(slower), "origin 50 50 20");  // S <= F
}

TEST_F(SettingLines, CoordinatesAreAllOfOneWay) {
  EXPECT_EQ(lines(NewCoordinates{{1, pulses(5)}, {2, pulses(-6)}}), "coordinates 1:5 2:-6");
  EXPECT_EQ(lines(NewCoordinates{}), "INVALID_REQUEST: no coordinate is given");
  EXPECT_EQ(lines(NewCoordinates{{1, {}}}), "INVALID_REQUEST: axis 1 has no coordinate");
  EXPECT_EQ(lines(NewCoordinates{{1, SetOrigin{}}, {2, UnsetOrigin{}}}),
            "INVALID_REQUEST: each axis once, and all in the same way");
  EXPECT_EQ(lines(NewCoordinates{{1, SetOrigin{}}, {1, SetOrigin{}}}),
            "INVALID_REQUEST: each axis once, and all in the same way");
  EXPECT_EQ(lines(NewCoordinates{{1, SetOrigin{}}}), "setting 14");
  EXPECT_EQ(lines(NewCoordinates{{1, UnsetOrigin{}}}), "setting 15");
}

class SavedPositionChecks : public ::testing::Test {
 protected:
  SavedPositionChecks() {
    state_.link = stage::LinkState::up;
    state_.serial_number = "77";
    state_.device_epoch = 3;
    position_.name = "sample";
    position_.coordinates = {{1, 50}};
    position_.serial_number = "77";
    position_.frame = server::frame_of(state_);
  }
  stage::State state_;
  server::SavedPosition position_;
};

TEST_F(SavedPositionChecks, InTheSameFrameItReportsWhatWasSaved) {
  EXPECT_EQ(expected_of(position_, state_), position_.coordinates);
  EXPECT_FALSE(may_be_lost(position_, state_));
  EXPECT_TRUE(check_unit(position_, state_));
}

TEST_F(SavedPositionChecks, APlaceWhoseCoordinatesWereSetAgainReportsAnything) {
  ++state_.frame_epoch;
  EXPECT_TRUE(expected_of(position_, state_).empty());
  position_.place = false;
  EXPECT_EQ(expected_of(position_, state_), position_.coordinates);
}

TEST_F(SavedPositionChecks, AfterAnInterruptionItReportsWhatWasSaved) {
  ++state_.device_epoch;
  ++state_.frame_epoch;
  EXPECT_EQ(expected_of(position_, state_), position_.coordinates);
  EXPECT_TRUE(may_be_lost(position_, state_));
  position_.place = false;
  EXPECT_FALSE(may_be_lost(position_, state_));
}

TEST_F(SavedPositionChecks, AnotherControllerHoldsIt) {
  state_.serial_number = "78";
  ASSERT_FALSE(check_unit(position_, state_));
  EXPECT_EQ(check_unit(position_, state_).error().reason, Reason::epoch_passed);
  EXPECT_TRUE(may_be_lost(position_, state_));
}

TEST_F(SavedPositionChecks, ARefusalSaysWhatHasBecomeOfIt) {
  Problem reported{.reason = Reason::epoch_passed, .message = "it holds 60", .sent = "PIT:GET1"};
  EXPECT_EQ(refusal_of(reported, position_, state_, {}).message, "\"sample\" is no longer there: it holds 60");
  EXPECT_EQ(refusal_of({.reason = Reason::axis_busy, .message = "busy"}, position_, state_, {}).message, "busy");
}

TEST_F(SavedPositionChecks, TwoAnswersThatDiffer) {
  const AnySetting kind;
  const auto coordinates = reported_coordinates(position_, "PIT:GET1", {"1", "2"}, kind, state_);
  ASSERT_FALSE(coordinates);
  EXPECT_EQ(coordinates.error().reason, Reason::line_fault);
  EXPECT_EQ(reported_coordinates(position_, "PIT:GET1", {"1", "1"}, kind, state_).error().reason,
            Reason::device_refused);
}

}  // namespace
}  // namespace axisgate::api
