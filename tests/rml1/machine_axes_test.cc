// Tests of machine coordinates of Z (guideline 3-3 !ZM, !ZO), and of axes that a machine has or lacks (!ZE).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "device/rml1/sending/timeline.h"
#include "tests/rml1/trace.h"

namespace axisgate::rml1 {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// Returns a mill whose Z0 lies 5000 below the top: at -5000 if coordinates grow upward, at 5000 if they grow downward.
Profile mill(int up) {
  Profile profile = test_profile();
  profile.up = up;
  return profile;
}
Played upward(const std::string& job) { return play(job, mill(1), kMidway); }
Played downward(const std::string& job) { return play(job, mill(-1), kMidway); }

TEST(MachineHeight, IsAbsoluteOrRelative) {
  EXPECT_THAT(ends(upward("!ZM-2000;")), ElementsAre("0 0 3000"));
  EXPECT_THAT(ends(upward("PR;!ZM-2000;!ZM-500;!ZM100;")), ElementsAre("0 0 3000", "0 0 2500", "0 0 2600"));
  EXPECT_THAT(ends(downward("!ZM2000;")), ElementsAre("0 0 3000"));
  EXPECT_THAT(ends(downward("PR;!ZM2000;!ZM500;!ZM-100;")), ElementsAre("0 0 3000", "0 0 2500", "0 0 2600"));
}

TEST(MachineHeight, CountsFromTheProfilesTop) {
  Profile profile = mill(1);
  profile.top = 6050;
  EXPECT_THAT(ends(play("!ZM6000;!ZM0;", profile, kMidway)), ElementsAre("0 0 4950", "0 0 -1050"));
}

TEST(MachineHeight, MovesZAloneAndKeepsZ0) {
  const Played found = upward("Z10,20,30;!ZM-2000;");
  EXPECT_THAT(ends(found), ElementsAre("10 20 30", "10 20 3000"));
  EXPECT_EQ(found.box.highest.z, 5000);
}

TEST(MachineHeight, ReachesBothEndsOfTheTravelAndNoFurther) {
  EXPECT_THAT(ends(upward("!ZM-6050;!ZM0;")), ElementsAre("0 0 -1050", "0 0 5000"));
  EXPECT_THAT(ends(downward("!ZM6050;!ZM0;")), ElementsAre("0 0 -1050", "0 0 5000"));
  for (const Played& found : {upward("!ZM1;"), upward("!ZM-6051;"), upward("PR;!ZM1;"), downward("!ZM-1;"),
                              downward("!ZM6051;"), upward("!ZM99999999;")}) {
    EXPECT_THAT(ends(found), IsEmpty());
    ASSERT_EQ(found.diagnostics.size(), 1u);
    EXPECT_EQ(found.diagnostics[0].number, 3);
  }
}

// "the decimal-fraction portion is ignored, and the resulting value must be within the Z-axis movement range"
TEST(MachineHeight, IgnoresFractions) {
  EXPECT_THAT(ends(upward("!ZM-2000.9;!ZM0.9;")), ElementsAre("0 0 3000", "0 0 5000"));
  EXPECT_THAT(upward("!ZM0.9;!ZM-6050.9;").diagnostics, IsEmpty());
}

TEST(MachineHeight, WithoutParameterDoesNothing) { EXPECT_THAT(ends(upward("Z0,0,30;!ZM;")), ElementsAre("0 0 30")); }

// The tool does not move: it stays at machine coordinate -4900, or 4900.
TEST(Surface, MovesUnderTheTool) {
  const Played up = upward("Z0,0,100;!ZO-4000;");
  EXPECT_THAT(ends(up), ElementsAre("0 0 100"));
  EXPECT_EQ(text(up.final), "0 0 -900");
  EXPECT_EQ(up.box.highest.z, 4000);
  EXPECT_EQ(up.box.lowest.z, -2050);
  const Played down = downward("Z0,0,100;!ZO4000;");
  EXPECT_EQ(text(down.final), "0 0 -900");
  EXPECT_EQ(down.box.highest.z, 4000);
  EXPECT_EQ(down.box.lowest.z, -2050);
}

// "the specified value referenced from the present Z-axis coordinate is made the Z-axis origin"
TEST(Surface, IsRelativeToThePresentHeight) {
  EXPECT_EQ(text(upward("Z0,0,100;PR;!ZO0;").final), "0 0 0");
  EXPECT_EQ(upward("Z0,0,100;PR;!ZO0;").box.highest.z, 4900);
  EXPECT_EQ(text(upward("Z0,0,100;PR;!ZO-50;").final), "0 0 50");
  EXPECT_EQ(text(downward("Z0,0,100;PR;!ZO50;").final), "0 0 50");
  EXPECT_EQ(downward("Z0,0,100;PR;!ZO50;").box.highest.z, 4950);
}

TEST(Surface, IsWhatTheNextHeightsCountFrom) {
  EXPECT_THAT(ends(upward("Z0,0,100;!ZO-4000;@-200,300;PU;PD;PR;Z0,0,50;")),
              ElementsAre("0 0 100", "0 0 300", "0 0 -200", "0 0 -150"));
}

TEST(Surface, WithoutParameterIsTheProfiles) {
  Profile profile = mill(1);
  profile.default_z0 = -3000;
  EXPECT_EQ(play("!ZO;", profile, kMidway).box.highest.z, 3000);
  EXPECT_EQ(play("PR;!ZO;", profile, kMidway).box.highest.z, 3000);
}

TEST(Surface, OutsideOfTheTravelIsNotSet) {
  for (const Played& found :
       {upward("!ZO1;"), upward("!ZO-6051;"), upward("PR;!ZO1;"), downward("!ZO-1;"), downward("!ZO6051;")}) {
    EXPECT_EQ(found.box.highest.z, 5000);
    ASSERT_EQ(found.diagnostics.size(), 1u);
    EXPECT_EQ(found.diagnostics[0].number, 3);
  }
  EXPECT_EQ(upward("!ZO-6050;").box.highest.z, 6050);
  EXPECT_EQ(upward("!ZO0.9;").box.highest.z, 0);
}

// "Specifying an axis that the model used does not have causes the specification for that axis to be ignored, but the
// other axes operate."
TEST(Axes, ThatAreMissingAreIgnored) {
  Profile profile = test_profile();
  profile.axes = "XZ";
  const Played found = play("!ZEX100Y200Z300;", profile, kMidway);
  EXPECT_THAT(ends(found), ElementsAre("100 0 300"));
  EXPECT_THAT(told(found.diagnostics), ElementsAre("warning 0 at 7"));
}

TEST(Axes, ThatAreMissingAreToldOfOnce) {
  const Played found = play("!ZEX1B2:C3;!ZEB4;", test_profile(), kMidway);
  EXPECT_THAT(ends(found), ElementsAre("1 0 5000"));
  EXPECT_THAT(told(found.diagnostics), ElementsAre("warning 0 at 5"));
}

// The axis turns by 10 degrees per second.
TEST(RotaryAxis, TurnsByDegrees) {
  EXPECT_THAT(upward("Z1,0,9;!ZEA90;!ZEA90;!ZEA60;").waits, ElementsAre("spin up 2", "turn 9", "turn 3"));
  EXPECT_THAT(upward("Z1,0,9;PR;!ZEA45;!ZEA45;!ZEA-45.5;").waits,
              ElementsAre("spin up 2", "turn 4.5", "turn 4.5", "turn 4.55"));
}

// A turn is a movement: at the high end of the range it takes longer, like a move.
TEST(RotaryAxis, MayTurnSlower) {
  Profile profile = test_profile();
  profile.acceleration.slower = 0.5;
  const Summary found = checked("!MC0;!ZEA90;", profile)->summary();
  EXPECT_NEAR(found.seconds_low, 9, 1e-9);
  EXPECT_NEAR(found.seconds_high, 13.5, 1e-9);
  const Timeline timeline("!MC0;!ZEA90;", profile, kMidway);
  EXPECT_NEAR(sum_of(timeline, &Step::least_s), 9, 1e-6);
  EXPECT_NEAR(timeline.slowest_s(), 13.5, 1e-6);
}

// A9000, A90.0 and A90. are all 90 degrees.
TEST(RotaryAxis, TurnsByHundredthsWhereNoPointIsWritten) {
  Profile profile = test_profile();
  profile.rotary->hundredths = true;
  EXPECT_THAT(play("Z1,0,9;!ZEA9000;!ZEA90.0;!ZEA90.;!ZEA0;", profile, kMidway).waits,
              ElementsAre("spin up 2", "turn 9", "turn 9"));
}

TEST(RotaryAxis, HasTheProfilesLetter) {
  Profile profile = test_profile();
  profile.rotary->letter = 'B';
  const Played found = play("Z1,0,9;!ZEB10;!ZEA10;", profile, kMidway);
  EXPECT_THAT(found.waits, ElementsAre("spin up 2", "turn 1"));
  EXPECT_THAT(told(found.diagnostics), ElementsAre("warning 0 at 17"));
}

TEST(RotaryAxis, IsIgnoredWhereThereIsNone) {
  Profile profile = test_profile();
  profile.rotary.reset();
  const Played found = play("Z1,0,9;!ZEA10;", profile, kMidway);
  EXPECT_THAT(found.waits, ElementsAre("spin up 2"));
  EXPECT_THAT(told(found.diagnostics), ElementsAre("warning 0 at 10"));
}

}  // namespace
}  // namespace axisgate::rml1
