// Tests of the settings that a job leaves in the machine, and of those that it takes over (guideline 3-1 H, 3-2 IN DF,
// 3-3, 5-3).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/rml1/trace.h"

namespace axisgate::rml1 {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> left_by(const std::string& job, const Profile& profile = test_profile()) {
  return told(checked(job, profile, {kMidway, {}, {}})->diagnostics().kept());
}

// The profile has Z1 at -100 steps.
TEST(DepthOfTheProfile, IsAWarningAtTheFirstCommandThatTakesIt) {
  const Profile profile = test_profile();
  const auto check = checked("PU9,9;PD;PU;PD;PU;", profile, {kMidway, {}, {}});
  EXPECT_THAT(told(check->diagnostics().kept()), ElementsAre("warning 0 at 6"));
  EXPECT_EQ(check->diagnostics().kept()[0].text,
            "lowers the tool before it sets Z1: Z -1.00 mm is from the profile, a mill may differ");
  for (const char* job : {"@;PD;PU;", "@-9,9;DF;PD;PU;", "@-9,9;IN;PD;PU;"}) {
    EXPECT_EQ(left_by(job).size(), 1u) << job;
  }
  for (const char* job : {"@-9;PD;PU;", "!PZ-9,9;D9,9;PU;", "Z0,0,-9;PU;", "PU;"}) {
    EXPECT_THAT(left_by(job), IsEmpty()) << job;
  }
}

// "There is no change ... in the value of Z0" (3-2 IN).
TEST(Surface, ThatIsSetStays) { EXPECT_THAT(left_by("PU;!ZO-5000;!ZO-5000;IN;"), ElementsAre("note 0 at 3")); }

TEST(SpindleSpeed, ThatIsSetStays) {
  const Profile profile = test_profile();
  const auto check = checked("PU;!RC5;!RC6;IN;", profile, {kMidway, {}, {}});
  EXPECT_THAT(told(check->diagnostics().kept()), ElementsAre("note 0 at 3"));
  EXPECT_THAT(check->diagnostics().kept()[0].text, HasSubstr("the test mill ignores it"));
  Profile other = test_profile();
  other.spindle.law = Spindle::Law::stages;
  EXPECT_THAT(checked("!RC5;", other)->diagnostics().kept().at(0).text, HasSubstr("do not reset it"));
  EXPECT_THAT(left_by("!RC;"), IsEmpty());
}

// Settings that no command resets for the next job, except those that the machine ignores.
TEST(WhatAJobLeaves, IsWhatDfAndInDoNotReset) {
  Profile profile = test_profile();
  const auto leaves = [&profile](const char* job) { return checked(job, profile, {kMidway, {}, {}})->leaves(); };
  EXPECT_EQ(leaves("PU;W100;!PZ-9,9;!MC0;PR;!ZEX9;"), jobs::Leaves());
  EXPECT_EQ(leaves("PU;!ZO-5000;"), jobs::Leaves{.surface = true});
  EXPECT_EQ(leaves("!RC5;PU;"), jobs::Leaves());
  profile.spindle.law = Spindle::Law::stages;
  EXPECT_EQ(leaves("!RC;PU;"), jobs::Leaves());
  EXPECT_EQ(leaves("!RC5;PU;DF;"), jobs::Leaves{.revolutions = true});
  EXPECT_EQ(leaves("PU;!ZEX9A90;H;"), jobs::Leaves{.rotation = true});
  profile.dialect.tolerated = {"J"};
  EXPECT_EQ(leaves("PU;J2;H;"), jobs::Leaves{.tool = true});
  profile.rotary.reset();
  EXPECT_EQ(leaves("PU;!ZEX9A90;H;"), jobs::Leaves());
}

// 5-3: I R PR make coordinates relative; M D H IN PA DF absolute.
TEST(RelativeCoordinates, AtTheEnd) {
  for (const char* job : {"PU;PR;", "PU;R9,9;", "PU;PR;PU9,9;"}) {
    EXPECT_THAT(left_by(job), ElementsAre("warning 0 at 3")) << job;
  }
  for (const char* end : {"PA;", "H;", "IN;", "DF;", "M9,9;"}) {
    EXPECT_THAT(left_by(std::string("PU;PR;") + end), IsEmpty()) << end;
  }
}

// "Dwell time is set to 0" by DF (3-2), and so by IN.
TEST(Dwell, AtTheEnd) {
  EXPECT_THAT(left_by("W100;PU;"), ElementsAre("note 0 at 0"));
  for (const char* job : {"W100;PU;W0;", "W100;PU;W;", "W100;PU;DF;", "!DW100;PU;IN;"}) {
    EXPECT_THAT(left_by(job), IsEmpty()) << job;
  }
}

}  // namespace
}  // namespace axisgate::rml1
