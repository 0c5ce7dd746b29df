#include <gmock/gmock.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "server/config/config.h"
#include "server/config/stage.h"
#include "server/kinds.h"
#include "tests/paths/paths.h"

namespace axisgate::server::config_stage_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

constexpr const char* kLinear =
    "name = \"OSMS20-85\"\nkind = \"linear\"\npulse = \"1um\"\nunit = \"mm\"\n"
    "travel_minimum = \"-1mm\"\ntravel_maximum = \"84\"\nmaximum_speed = \"10mm/s\"\n";
constexpr const char* kRotary =
    "name = \"OSMS-60YAW\"\nkind = \"rotary\"\npulse = \"0.0025deg\"\nmaximum_speed = \"30deg/s\"\n"
    "modulo = \"360deg\"\n";

// A configuration in its own folder, whose axis, from line 4 on, names a profile in the subfolder; added lines begin in
// line 7.
class ConfigStage : public testing::Test {
 protected:
  ConfigStage() {
    std::filesystem::create_directories(folder + "/stages");
    config_file = folder + "/lab.toml";
    stage_file = folder + "/stages/x.toml";
  }
  ~ConfigStage() override { std::filesystem::remove_all(folder); }

  Configured<Config> read(const std::string& stage, const std::string& lines = "") const {
    std::ofstream(stage_file) << stage;
    std::ofstream(config_file) << "[[device]]\nname = \"stage\"\nconnection = \"simulated\"\n"
                                  "[[device.axis]]\nnumber = 1\nstage = \"stages/x.toml\"\n"
                               << lines;
    return load_config(config_file, device_kinds());
  }

  stage::AxisProfile axis(const std::string& stage, const std::string& lines = "") const {
    const auto config = read(stage, lines);
    EXPECT_TRUE(config) << to_string(config.error().front());
    return config ? std::get<StageConfig>(config->devices.at(0).family).profile.axes[0] : stage::AxisProfile{};
  }

  // Returns the errors with the folder removed from their paths.
  std::vector<std::string> errors(const std::string& stage, const std::string& lines = "") const {
    std::vector<std::string> told;
    if (const auto config = read(stage, lines); !config) {
      for (const ConfigError& error : config.error()) {
        std::string text = to_string(error);
        for (auto at = text.find(folder); at != std::string::npos; at = text.find(folder)) {
          text.erase(at, folder.size() + 1);
        }
        told.push_back(text);
      }
    }
    return told;
  }

  const std::string folder =
      ::testing::TempDir() + "axisgate_" + ::testing::UnitTest::GetInstance()->current_test_info()->name();
  std::string config_file, stage_file;
};

std::string text(const std::optional<Quantity>& quantity) {
  return quantity ? to_string(quantity->value) + std::string(symbol(quantity->unit)) : "none";
}

TEST_F(ConfigStage, ItsFiguresHoldForTheAxis) {
  const auto x = axis(kLinear);
  ASSERT_TRUE(x.stage);
  EXPECT_EQ(x.stage->model, "OSMS20-85");
  EXPECT_EQ(x.stage->pulse, (Scale{{1000, 0}, false}));
  EXPECT_FALSE(x.stage->modulo);
  EXPECT_FALSE(x.rotary());
  EXPECT_EQ(x.unit, Unit::millimeters);
  EXPECT_EQ(text(x.travel_minimum), "-1mm");
  EXPECT_EQ(text(x.travel_maximum), "84mm") << "a bare number is in the profile's own unit";
  EXPECT_EQ(text(x.maximum_speed), "10mm");
}

TEST_F(ConfigStage, OneThatTurns) {
  const auto turn = axis(kRotary);
  ASSERT_TRUE(turn.stage);
  EXPECT_EQ(turn.stage->pulse, (Scale{{2500, 0}, true}));
  EXPECT_EQ(turn.stage->modulo, (Decimal{360, 0}));
  EXPECT_TRUE(turn.rotary());
  EXPECT_EQ(turn.unit, Unit::degrees);
  EXPECT_EQ(text(turn.maximum_speed), "30deg");
  EXPECT_EQ(text(turn.travel_minimum), "none");
  EXPECT_TRUE(axis(kRotary, "unit = \"pulse\"\n").rotary()) << "however it is shown";
}

TEST_F(ConfigStage, TheAxisMayHaveLess) {
  const auto x = axis(kLinear, "unit = \"um\"\ntravel_minimum = \"0\"\nmaximum_speed = \"500\"\n");
  EXPECT_EQ(x.unit, Unit::micrometers);
  EXPECT_EQ(text(x.travel_minimum), "0um");
  EXPECT_EQ(text(x.travel_maximum), "84mm");
  EXPECT_EQ(text(x.maximum_speed), "500um");
  EXPECT_EQ(text(axis(kLinear, "travel_maximum = \"84000pulse\"\n").travel_maximum), "84000pulse") << "as much";
  EXPECT_EQ(text(axis(kRotary, "travel_minimum = \"-2.5deg\"\n").travel_minimum), "-2.5deg") << "the profile says none";
}

TEST_F(ConfigStage, TheAxisCannotHaveMore) {
  EXPECT_THAT(
      errors(kLinear, "travel_minimum = \"-1001um\"\ntravel_maximum = \"84001pulse\"\nmaximum_speed = \"11\"\n"),
      ElementsAre(
          "lab.toml:7: device.axis.travel_minimum: is beyond that of the stage, -1mm of the OSMS20-85; an axis "
          "can only have less",
          "lab.toml:8: device.axis.travel_maximum: is beyond that of the stage, 84mm of the OSMS20-85; an axis "
          "can only have less",
          "lab.toml:9: device.axis.maximum_speed: is beyond that of the stage, 10mm/s of the OSMS20-85; an axis "
          "can only have less"));
}

TEST_F(ConfigStage, ATravelIsLeft) {
  EXPECT_THAT(errors(kLinear, "travel_minimum = \"84\"\n"),
              ElementsAre("lab.toml:7: device.axis.travel_minimum: must be below travel_maximum"));
  EXPECT_THAT(errors(kLinear, "travel_maximum = \"-1000pulse\"\n"),
              ElementsAre("lab.toml:7: device.axis.travel_maximum: must be above travel_minimum"));
  EXPECT_THAT(errors(kLinear, "travel_minimum = \"5\"\ntravel_maximum = \"4\"\n"),
              ElementsAre("lab.toml:7: device.axis.travel_minimum: must be below travel_maximum"));
}

TEST_F(ConfigStage, AmountsAreWholePulses) {
  EXPECT_THAT(errors(kLinear,
                     "travel_maximum = \"5.0005\"\n[[device.axis.override]]\nwhose = \"operator\"\n"
                     "maximum_speed = \"1500nm/s\"\n"),
              ElementsAre(StartsWith("lab.toml:7: device.axis.travel_maximum: \"5.0005mm\" is not a whole number of "
                                     "pulses of 1000 nm; the nearest are 5mm and 5.001mm"),
                          StartsWith("lab.toml:10: device.axis.override.maximum_speed: \"1500nm/s\" is not a whole "
                                     "number of pulses of 1000 nm a second; the nearest are 1000nm/s and 2000nm/s")));
  EXPECT_THAT(errors("name = \"x\"\nkind = \"linear\"\npulse = \"3um\"\ntravel_maximum = \"10um\"\n"),
              ElementsAre(StartsWith("stages/x.toml:4: travel_maximum: \"10um\" is not a whole number of pulses of")));
}

TEST_F(ConfigStage, OverridesAreWithinTheStages) {
  EXPECT_THAT(
      errors(kLinear, "[[device.axis.override]]\nwhose = \"operator\"\ntravel_maximum = \"85mm\"\n"),
      ElementsAre("lab.toml:9: device.axis.override.travel_maximum: is beyond the axis's own travel_maximum, so "
                  "it would change nothing"));
}

TEST_F(ConfigStage, UnitsFitTheStage) {
  EXPECT_THAT(errors(kLinear, "unit = \"deg\"\n"),
              ElementsAre("lab.toml:7: device.axis.unit: deg is for a stage that turns, and this one slides"));
  EXPECT_THAT(errors(kRotary, "unit = \"mm\"\n"),
              ElementsAre("lab.toml:7: device.axis.unit: mm is for a stage that slides, and this one turns"));
  EXPECT_THAT(errors(kRotary, "travel_maximum = \"5mm\"\n"),
              ElementsAre(StartsWith("lab.toml:7: device.axis.travel_maximum: is in mm, but the axis is shown in deg"),
                          StartsWith("lab.toml:7: device.axis.travel_maximum: a length (mm) was given for an axis that "
                                     "turns")));
}

TEST_F(ConfigStage, WhatEveryProfileSays) {
  EXPECT_THAT(
      errors("unit = \"mm\"\n"),
      ElementsAre("stages/x.toml:1: name: is missing; use the stage's model, 1 to 64 printable ASCII characters",
                  "stages/x.toml:1: kind: is missing; use \"linear\" or \"rotary\""));
  EXPECT_THAT(
      errors("name = \"\\u001b[2J\"\nkind = \"linear\"\n"),
      ElementsAre(
          "stages/x.toml:1: name: will not do; use the stage's model, 1 to 64 printable ASCII "
          "characters",
          "stages/x.toml:1: pulse: is missing; use the displacement of one pulse as a text in quotes, \"1um\""));
  EXPECT_THAT(errors("name = \"x\"\nkind = \"round\"\n"),
              ElementsAre("stages/x.toml:2: kind: \"round\" is not known; use one of \"linear\", \"rotary\""));
}

TEST_F(ConfigStage, APulseIsAWayOfItsKind) {
  const std::string linear = "name = \"x\"\nkind = \"linear\"\n", rotary = "name = \"x\"\nkind = \"rotary\"\n";
  EXPECT_THAT(errors(linear + "pulse = 1\n"),
              ElementsAre("stages/x.toml:3: pulse: 1 will not do; use a text in quotes"));
  EXPECT_THAT(
      errors(linear + "pulse = \"1\"\n"),
      ElementsAre(
          "stages/x.toml:3: pulse: \"1pulse\" is no resolution (displacement of one pulse). Give a displacement "
          "above 0 in nm, um, mm "
          "or deg."));
  EXPECT_THAT(errors(linear + "pulse = \"0um\"\n"),
              ElementsAre(HasSubstr("pulse: \"0um\" is no resolution (displacement of one pulse)")));
  EXPECT_THAT(errors(linear + "pulse = \"1inch\"\n"), ElementsAre(HasSubstr("pulse: \"inch\" is not a unit")));
  EXPECT_THAT(
      errors(linear + "pulse = \"0.0025deg\"\n"),
      ElementsAre(
          "stages/x.toml:3: pulse: is in deg, and the stage slides; use the displacement of one pulse as a text in "
          "quotes, \"1um\""));
  EXPECT_THAT(
      errors(rotary + "pulse = \"1um\"\n"),
      ElementsAre(
          "stages/x.toml:3: pulse: is in um, and the stage turns; use the displacement of one pulse as a text in "
          "quotes, \"0.0025deg\""));
}

TEST_F(ConfigStage, ATurnIsOfStagesThatTurn) {
  const std::string rotary = "name = \"x\"\nkind = \"rotary\"\npulse = \"0.0025deg\"\n";
  EXPECT_THAT(errors(std::string(kLinear) + "modulo = \"360deg\"\n"),
              ElementsAre("stages/x.toml:8: modulo: is of rotary stages only; leave it out"));
  EXPECT_THAT(errors(rotary + "modulo = \"0\"\n"),
              ElementsAre("stages/x.toml:4: modulo: \"0\" is no turn; use degrees above 0, \"360deg\""));
  EXPECT_THAT(errors(rotary + "modulo = \"360mm\"\n"), ElementsAre(HasSubstr("modulo: \"360mm\" is no turn")));
  EXPECT_THAT(errors(rotary + "modulo = 360\n"), ElementsAre(HasSubstr("modulo: 360 will not do; use a text")));
  EXPECT_EQ(axis(rotary + "modulo = \"22.5\"\n").stage->modulo, (Decimal{225, 1}));
}

TEST_F(ConfigStage, UnknownKeysAndLimitsThatContradictOneAnother) {
  EXPECT_THAT(errors(std::string(kLinear) + "stroke = \"85mm\"\n"),
              ElementsAre("stages/x.toml:8: stroke: is not a key here; use name, kind, pulse, unit, travel_minimum, "
                          "travel_maximum, maximum_speed, modulo"));
  EXPECT_THAT(errors("name = \"x\"\nkind = \"linear\"\npulse = \"1um\"\ntravel_minimum = \"5mm\"\n"
                     "travel_maximum = \"5mm\"\nmaximum_speed = \"-1\"\n"),
              ElementsAre("stages/x.toml:4: travel_minimum: must be below travel_maximum",
                          "stages/x.toml:6: maximum_speed: must be above 0"));
}

// The axis's own keys are not blamed for an invalid profile, and a profile of two axes is reported once.
TEST_F(ConfigStage, OfAProfileThatIsWrongOnlyItselfIsTold) {
  EXPECT_THAT(errors("name = \"x\"\nkind = \"rotary\"\n",
                     "travel_maximum = \"90deg\"\n[[device.axis]]\nnumber = 2\nstage = \"stages/x.toml\"\n"),
              ElementsAre(StartsWith("stages/x.toml:1: pulse: is missing; use ")));
}

TEST_F(ConfigStage, ErrorsOfTheConfigurationComeFirst) {
  EXPECT_THAT(errors("name = \"x\"\nkind = \"linear\"\n", "colour = \"red\"\n"),
              ElementsAre(StartsWith("lab.toml:7: device.axis.colour: is not a key here"),
                          StartsWith("stages/x.toml:1: pulse: is missing; use ")));
}

TEST_F(ConfigStage, FilesThatCannotBeRead) {
  EXPECT_THAT(errors("name = \"x\n"), ElementsAre(StartsWith("stages/x.toml:1: is not TOML: ")));
  ASSERT_TRUE(read(kLinear));
  std::filesystem::remove(stage_file);
  const auto missing = load_config(config_file, device_kinds());
  ASSERT_FALSE(missing);
  EXPECT_EQ(
      to_string(missing.error().at(0)),
      config_file + ":6: device.axis.stage: " + stage_file +
          " cannot be opened: No such file or directory; use the path of a stage profile, from the folder of this "
          "file on");
  for (const char* stage : {"\"\"", "5"}) {
    const auto wrong = parse_config(std::string("[[device]]\nname = \"stage\"\nconnection = \"simulated\"\n"
                                                "[[device.axis]]\nnumber = 1\nstage = ") +
                                        stage + "\n",
                                    "lab.toml", device_kinds());
    ASSERT_FALSE(wrong);
    EXPECT_THAT(to_string(wrong.error().at(0)), StartsWith("lab.toml:6: device.axis.stage: "));
  }
}

TEST(ConfigStageTable, TheProfileMayStandInTheConfigurationItself) {
  const std::string head = "[[device]]\nname = \"stage\"\nconnection = \"simulated\"\n[[device.axis]]\nnumber = 1\n";
  const auto config = parse_config(head + "[device.axis.stage]\n" + kLinear, "lab.toml", device_kinds());
  ASSERT_TRUE(config) << to_string(config.error().front());
  EXPECT_EQ(std::get<StageConfig>(config->devices.at(0).family).profile.axes[0].stage->model, "OSMS20-85");
  const auto wrong = parse_config(head + "[device.axis.stage]\nname = \"x\"\nkind = \"linear\"\npulse = \"1\"\n",
                                  "lab.toml", device_kinds());
  ASSERT_FALSE(wrong);
  EXPECT_THAT(to_string(wrong.error().at(0)), StartsWith("lab.toml:9: device.axis.stage.pulse: "));
}

TEST(ConfigStageFiles, EveryProfileThatIsShippedIsRight) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(paths::in_project("deploy/stages"))) {
    ++count;
    const auto config = parse_config(
        "[[device]]\nname = \"stage\"\nconnection = \"simulated\"\n[[device.axis]]\nnumber = 1\nstage = \"" +
            entry.path().string() + "\"\n",
        "lab.toml", device_kinds());
    ASSERT_TRUE(config) << to_string(config.error().front());
    EXPECT_TRUE(std::get<StageConfig>(config->devices.at(0).family).profile.axes[0].stage) << entry.path();
  }
  EXPECT_GT(count, 3);
}

}  // namespace
}  // namespace axisgate::server::config_stage_test
