#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "server/config/config.h"
#include "server/kinds.h"

namespace axisgate::server::config_axis_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

// An axis in mm from line 4 on, with 10 mm of travel; added lines begin in line 10.
constexpr const char* kAxis =
    "[[device]]\nname = \"stage\"\nconnection = \"simulated\"\n"
    "[[device.axis]]\nnumber = 1\nunit = \"mm\"\n"
    "travel_minimum = \"-5\"\ntravel_maximum = \"5\"\nmaximum_speed = \"2\"\n";

std::vector<std::string> errors_of_axis(const std::string& lines) {
  std::vector<std::string> errors;
  if (const auto config = parse_config(kAxis + lines, "lab.toml", device_kinds()); !config) {
    for (const ConfigError& error : config.error()) errors.push_back(to_string(error));
  }
  return errors;
}

// A table for operators, whose keys begin in line 12.
std::vector<std::string> errors_of_override(const std::string& lines) {
  return errors_of_axis("[[device.axis.override]]\nwhose = \"operator\"\n" + lines);
}

std::vector<std::string> errors_of_whose(const std::string& whose) {
  return errors_of_axis("[[device.axis.override]]\nwhose = \"" + whose + "\"\nrequire_homing = true\n");
}

TEST(ConfigAxis, OverridesAreReadWhole) {
  const auto config = parse_config(std::string(kAxis) + R"(require_homing = true

[[device.axis.override]]
whose = "operator"
travel_minimum = "-4"
travel_maximum = "4000um"

[[device.axis.override]]
whose = "token student"
maximum_speed = "0.5mm/s"
require_homing = true

[[device.axis]]
number = 2
)",
                                   "lab.toml", device_kinds());
  ASSERT_TRUE(config) << to_string(config.error().front());
  const auto& axes = std::get<StageConfig>(config->devices.at(0).family).profile.axes;
  EXPECT_TRUE(axes[0].require_homing);
  ASSERT_EQ(axes[0].overrides.size(), 2u);
  const auto& operators = axes[0].overrides[0];
  EXPECT_EQ(operators.whose, "operator");
  EXPECT_EQ(operators.travel_minimum->value, (Decimal{-4, 0}));
  EXPECT_EQ(operators.travel_minimum->unit, Unit::millimeters) << "as the axis is shown";
  EXPECT_EQ(operators.travel_maximum->unit, Unit::micrometers);
  EXPECT_FALSE(operators.maximum_speed || operators.require_homing);
  const auto& student = axes[0].overrides[1];
  EXPECT_EQ(student.whose, "token student");
  EXPECT_EQ(student.maximum_speed->value, (Decimal{5, 1}));
  EXPECT_TRUE(student.require_homing);
  EXPECT_FALSE(student.travel_minimum || student.travel_maximum);
  EXPECT_FALSE(axes[1].require_homing) << "by default";
  EXPECT_THAT(axes[1].overrides, IsEmpty());
}

TEST(ConfigAxis, HomeFirstIsTrueOrFalse) {
  EXPECT_THAT(errors_of_axis("require_homing = false\n"), IsEmpty());
  EXPECT_THAT(errors_of_axis("require_homing = \"yes\"\n"),
              ElementsAre("lab.toml:10: device.axis.require_homing: the text \"yes\" will not do; use true or false"));
}

TEST(ConfigAxis, ItIsSaidWhomTheLimitsMean) {
  for (const char* whose : {"operator", "admin", "unix guest", "unix uid 1234", "cert guest", "cert Ann Lee",
                            "token student", "token night-scan"}) {
    EXPECT_THAT(errors_of_whose(whose), IsEmpty()) << whose;
  }
  EXPECT_THAT(errors_of_axis("[[device.axis.override]]\nrequire_homing = true\n"),
              ElementsAre(StartsWith("lab.toml:10: device.axis.override.whose: is missing; use a role, \"operator\"")));
}

// A misspelled name must be an error: if it matched nobody, its caller would move with everybody's limits.
TEST(ConfigAxis, NobodyIsMeantByASlip) {
  for (const char* whose : {"student", "oprator", "Operator", "", "tokens student", "Token student"}) {
    EXPECT_THAT(errors_of_whose(whose),
                ElementsAre(std::string("lab.toml:11: device.axis.override.whose: \"") + whose +
                            "\" is neither a role nor a caller as the daemon names them; use a role, \"operator\" or "
                            "\"admin\", or a caller, \"unix LOGIN\", \"cert NAME\" or \"token NAME\""))
        << whose;
  }
  for (const char* whose : {"token", "token ", "unix  guest", "cert guest "}) {
    EXPECT_THAT(errors_of_whose(whose), ElementsAre(HasSubstr("\" names nobody; use "))) << whose;
  }
  EXPECT_THAT(errors_of_whose("token student 2"), ElementsAre(HasSubstr("\" is not a token's name; use ")));
  EXPECT_THAT(errors_of_whose("unix Ann Lee"), ElementsAre(HasSubstr("\" is not a login; use ")));
}

TEST(ConfigAxis, LimitsOfThoseWhoDoNotMoveOrAreNotKnown) {
  EXPECT_THAT(
      errors_of_whose("observer"),
      ElementsAre(StartsWith("lab.toml:11: device.axis.override.whose: \"observer\" moves nothing anyway; use ")));
  EXPECT_THAT(errors_of_whose("tcp 127.0.0.1:39482"),
              ElementsAre(HasSubstr("is known by an address only, which everybody on this machine may have; use ")));
}

TEST(ConfigAxis, OverridesAreInUnitsOfTheAxis) {
  EXPECT_THAT(errors_of_override("travel_maximum = \"3deg\"\n"),
              ElementsAre(StartsWith("lab.toml:12: device.axis.override.travel_maximum: is in deg, but the axis is "
                                     "shown in mm")));
  EXPECT_THAT(errors_of_override("maximum_speed = \"0\"\n"),
              ElementsAre("lab.toml:12: device.axis.override.maximum_speed: must be above 0"));
  EXPECT_THAT(errors_of_override("travel_minimum = \"near\"\n"),
              ElementsAre(StartsWith("lab.toml:12: device.axis.override.travel_minimum: ")));
  EXPECT_THAT(errors_of_override("travel_minimum = \"2\"\ntravel_maximum = \"1\"\n"),
              ElementsAre("lab.toml:12: device.axis.override.travel_minimum: must be below travel_maximum"));
  EXPECT_THAT(errors_of_override("travel = \"2\"\nrequire_homing = true\n"),
              ElementsAre(StartsWith("lab.toml:12: device.axis.override.travel: is not a key here; use whose, ")));
}

TEST(ConfigAxis, WhatWouldChangeNothingIsAnError) {
  EXPECT_THAT(
      errors_of_override(""),
      ElementsAre("lab.toml:11: device.axis.override.whose: is limited in nothing; give some of travel_minimum, "
                  "travel_maximum, maximum_speed, require_homing"));
  EXPECT_THAT(
      errors_of_override("travel_minimum = \"-5001um\"\ntravel_maximum = \"6\"\nmaximum_speed = \"3\"\n"),
      ElementsAre("lab.toml:12: device.axis.override.travel_minimum: is beyond the axis's own travel_minimum, so "
                  "it would change nothing",
                  "lab.toml:13: device.axis.override.travel_maximum: is beyond the axis's own travel_maximum, so "
                  "it would change nothing",
                  "lab.toml:14: device.axis.override.maximum_speed: is beyond the axis's own maximum_speed, so it "
                  "would change nothing"));
  EXPECT_THAT(errors_of_override("require_homing = false\n"),
              ElementsAre(StartsWith("lab.toml:12: device.axis.override.require_homing: can only be true here")));
  EXPECT_THAT(errors_of_override("travel_maximum = \"5000um\"\n"), IsEmpty()) << "as far as everybody's";
}

TEST(ConfigAxis, ATravelIsLeft) {
  EXPECT_THAT(errors_of_override("travel_minimum = \"5\"\n"),
              ElementsAre("lab.toml:12: device.axis.override.travel_minimum: must be below the axis's own "
                          "travel_maximum"));
  EXPECT_THAT(errors_of_override("travel_maximum = \"-5.5\"\n"),
              ElementsAre("lab.toml:12: device.axis.override.travel_maximum: must be above the axis's own "
                          "travel_minimum"));
}

TEST(ConfigAxis, WhatOnlyTheControllerCanCompareIsLeftToIt) {
  EXPECT_THAT(errors_of_override("travel_maximum = \"900000000pulse\"\nmaximum_speed = \"999999pulse/s\"\n"),
              IsEmpty());
}

TEST(ConfigAxis, OneTableForEach) {
  EXPECT_THAT(errors_of_override("travel_maximum = \"4\"\n\n[[device.axis.override]]\nwhose = \"operator\"\n"
                                 "maximum_speed = \"1\"\n\n[[device.axis.override]]\nwhose = \"token student\"\n"
                                 "maximum_speed = \"1\"\n\n[[device.axis]]\nnumber = 2\n\n[[device.axis.override]]\n"
                                 "whose = \"operator\"\nmaximum_speed = \"1\"\n"),
              ElementsAre("lab.toml:15: device.axis.override.whose: \"operator\" has an override of this axis "
                          "already; put them together"));
}

}  // namespace
}  // namespace axisgate::server::config_axis_test
