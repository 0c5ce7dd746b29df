// Regression tests of fixed faults, each with the smallest job that showed the fault.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/rml1/trace.h"

namespace axisgate::rml1 {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// "If X and Y movement is necessary thereafter, the movement is performed at the maximum height", and "PU operates at a
// particular specified speed" (3-2 PU): 15 mm/s here, not the speed of V.
TEST(OnceWrong, TravelAtTheTopWentAtTheSpeedOfZ) {
  for (const char* job : {"V1;@-9,9000;PU100,0;", "V1;@-9,9000;M100,0;", "V1;@-9,9000;PA100,0;"}) {
    const Played found = play(job, test_profile(), kMidway);
    ASSERT_EQ(found.moves.size(), 1u) << job;
    EXPECT_EQ(found.moves[0].speed, 15) << job;
  }
  EXPECT_EQ(play("V1;F7;@-1000;!ZO-6000;PD100,0;", test_profile(), kMidway).moves.back().speed, 7);
}

// Z0 is unknown without an origin.
TEST(OnceWrong, RelativeHeightsWithoutAnOriginWereErrors) {
  for (const char* job : {"PD;PR;!ZM50;PU;", "PD;PR;!ZO0;PU;"}) {
    EXPECT_THAT(told(play(job, test_profile()).diagnostics), IsEmpty()) << job;
  }
}

// ESC.K "ends operation of the command now being executed" (4-2), half the distance out of the area, at Y = 150.
TEST(OnceWrong, QuitLeftTheCommandedPlaceWhereItWas) {
  EXPECT_EQ(text(play("Z0,0,0;Z-20000,300,0;\x1B.K!ZEX100;", test_profile(), kMidway).final), "100 150 0");
}

// "A value of 0 is the lowest spindle speed"; "Models that are not capable of saving the spindle speed use the minimum
// speed" (3-3 !RC).
TEST(OnceWrong, TheSpindleBeganAtItsHighestSpeed) {
  Profile profile = test_profile();
  profile.spindle.law = Spindle::Law::stages;
  profile.spindle.minimum_rpm = 1000;
  EXPECT_EQ(checked("", profile)->machine().rpm(), 1000);
}

TEST(OnceWrong, ATurnAloneDidNotStartTheSpindle) {
  EXPECT_THAT(play("!ZEA90;", test_profile(), kMidway).waits, ElementsAre("spin up 2", "turn 9"));
}

// 297 bytes take 9.9 s at 300 baud.
TEST(OnceWrong, SpinUpDidNotWaitForItsCommand) {
  Profile profile = test_profile();
  profile.baud = 300;
  const CheckOptions options{kMidway, {}, {}};
  const auto late = checked(std::string(297, ' ') + "PD;", profile, options)->summary();
  const auto early = checked("PD;", profile, options)->summary();
  EXPECT_NEAR(late.seconds_low - early.seconds_low, 9.9, 1e-6);
  EXPECT_NEAR(late.seconds_high - early.seconds_high, 9.9, 1e-6);
}

// The origin is 10 mm left of the home corner: both tool and commanded place begin at the corner.
TEST(OnceWrong, AnOriginOutsideMovedNothing) {
  EXPECT_EQ(text(play("!ZEY100;", test_profile(), jobs::Origin{-10, 5, 50}).final), "1000 100 5000");
  EXPECT_EQ(text(play("PD;", test_profile(), jobs::Origin{-10, 5, 50}).final), "1000 0 -100");
}

TEST(OnceWrong, GCodeDependedOnTheSplit) {
  const Profile profile = test_profile();
  for (const std::string job : {"G\n0", "N;1",
                                "G\x1B"
                                "1",
                                " \nG0", "G", "(", "G1", "\xEF\xBB\xBFG0"}) {
    const auto whole = checked(job, profile);
    for (std::size_t cut = 1; cut < job.size(); ++cut) {
      Check check(profile, {});
      check.feed(job.substr(0, cut));
      check.feed(job.substr(cut));
      check.finish();
      EXPECT_EQ(told(check.diagnostics().kept()), told(whole->diagnostics().kept())) << job << " at " << cut;
    }
  }
}

// The cuts are 150 mm wide, regardless of the tool's place before.
TEST(OnceWrong, TheBeginningCountedAsSize) {
  EXPECT_THAT(told_but_z1(checked("PU50000,0;PD65000,0;PU50000,0;", test_profile())->diagnostics().kept()), IsEmpty());
}

// A lift takes the tool out of the groove, and cuts nothing.
TEST(OnceWrong, ALiftWithTheSpindleStoppedWasCutting) {
  EXPECT_THAT(told_but_z1(checked("PU0,0;PD1000,0;!MC0;PU;", test_profile())->diagnostics().kept()), IsEmpty());
}

TEST(OnceWrong, WhatIsHeldAtTheEdgeWasSilent) {
  Profile profile = test_profile();
  profile.holds_flat_commands = true;
  EXPECT_THAT(told_but_z1(checked("PU0,0;PD-20000,0,0,0;PU;", profile, {kMidway, {}, {}})->diagnostics().kept()),
              ElementsAre("warning 0 at 6"));
}

// ESC is the tenth byte.
TEST(OnceWrong, AnEscapeInGroupsOfAxesWasToldAtTheNextByte) {
  EXPECT_THAT(told(play("!ZE X100 \x1BY100;", test_profile(), kMidway).diagnostics), ElementsAre("error 3 at 9"));
}

// 6050 steps of 0.01 mm are the whole travel of the other machine.
TEST(OnceWrong, ALiftByExtensionAxesWasNotJudged) {
  Profile profile = test_profile();
  profile.step_mm = 0.025;
  const CheckOptions options{kMidway, {}, {{"another", 0.01, 60.5}}};
  for (const char* job : {"PU0,0;^PR;!ZE Z6050;PA;", "PU0,0;^PR;Z0,0,6050;PA;"}) {
    EXPECT_THAT(told(checked(job, profile, options)->diagnostics().kept()), ElementsAre("warning 0 at 10")) << job;
  }
}

// !ZO without a number sets the height of the profile.
TEST(OnceWrong, AHeightOfTheProfileWasBlamedOnAnEarlierNumber) {
  Profile profile = test_profile();
  profile.default_z0 = 100;
  EXPECT_THAT(told(play("PU0,0;!ZO;", profile, kMidway).diagnostics), ElementsAre("error 3 at 6"));
}

// Z travels 6050 steps. Z0 is unknown, but lies within the travel.
TEST(OnceWrong, ARelativeSurfaceWithoutAnOriginHadNoEnd) {
  const auto told_of = [](const char* job) { return told(play(job, test_profile()).diagnostics); };
  EXPECT_THAT(told_of("PR;!ZO6051;"), ElementsAre("error 3 at 6"));
  // From 100 below Z0 down by a whole travel is possible only from the top to the bottom.
  EXPECT_THAT(told_of("PD;PR;!ZO-5950;"), IsEmpty());
  EXPECT_THAT(told_of("PD;PR;!ZO-5950;!ZO-5951;"), ElementsAre("error 3 at 18"));
  for (const char* job : {"PD;PR;!ZO-5950;", "PD;PR;!ZO-6000;PD;", "PR;!ZO0;!ZO-100;PD9,9;"}) {
    const Box box = play(job, test_profile()).box;
    EXPECT_LE(box.lowest.z, box.highest.z) << job;
  }
}

// The top is 493.2 steps above Z0.
TEST(OnceWrong, TheTopWasRoundedDown) {
  const Profile profile = test_profile();
  const jobs::Origin origin{10, 10, 493.2 * profile.step_mm};
  EXPECT_THAT(play("PU;", profile, origin).moves, IsEmpty());
  EXPECT_THAT(play("!ZM0;", profile, origin).moves, IsEmpty());
  EXPECT_NEAR(play("!ZM-10;", profile, origin).final.z, 483.2, 1e-9);
}

// PD alone drills a hole. Z0 lies 10 steps above the bottom.
TEST(OnceWrong, AHoleBelowTheBottomWasSilent) {
  const Profile profile = test_profile();
  const jobs::Origin origin{10, 10, profile.z_mm - 10 * profile.step_mm};
  const auto check = checked("!PZ-5,9;PD;PU;!PZ-11,9;", profile, {origin, {}, {}});
  EXPECT_THAT(told(check->diagnostics().kept()), ElementsAre(testing::HasSubstr("error 3")));
  EXPECT_THAT(told(checked("!PZ-5;!ZO-6047;PD;PU;", profile, {origin, {}, {}})->diagnostics().kept()),
              ElementsAre("note 0 at 6", "warning 0 at 15"));
}

TEST(OnceWrong, ACutFromTheBeginningHadNoSize) {
  EXPECT_THAT(told_but_z1(checked("PD65000,0;PU;", test_profile())->diagnostics().kept()), ElementsAre("error 0 at 0"));
}

// With a known origin, it is also known that the move to a parking place is not driven beyond the edge.
TEST(OnceWrong, ParkingOutsideWasLargerThanTheMachine) {
  const auto check = checked("PU0,0;PD1000,0;PU65000,0;", test_profile(), {kMidway, {}, {}});
  EXPECT_THAT(told_but_z1(check->diagnostics().kept()), ElementsAre("note 0 at 15"));
}

// PU performs "only a tool-up operation" (3-2): the tool waits where the path left the area, at X 300, Y 60.
TEST(OnceWrong, ALiftOutsideWentToTheNearestEdge) {
  Profile profile = test_profile();
  profile.holds_flat_commands = true;
  profile.x_mm = 4;
  const Played found = play("Z500,100,-10;PU;", profile, jobs::Origin{1, 1, 0.5});
  EXPECT_EQ(text(found.final), "300 60 14");
}

// The bottom is 200 steps below the top. The sum is 0.4 steps lower, but rounds to the step of the bottom.
TEST(OnceWrong, AHeightWhoseStepIsReachedWasAnError) {
  Profile profile = test_profile();
  profile.z_mm = 2;
  const Played found = play("PA;Z0,0,-100;PR;!ZM-50;", profile, jobs::Origin{1, 1, 0.504});
  EXPECT_THAT(found.diagnostics, IsEmpty());
}

TEST(OnceWrong, ANameBehindACircumflexWasToldInPart) {
  EXPECT_THAT(play("^!XX;", test_profile()).diagnostics.at(0).text, testing::HasSubstr("followed by \"!XX\""));
  EXPECT_THAT(play("^PX;", test_profile()).diagnostics.at(0).text, testing::HasSubstr("followed by \"PX\""));
}

// The range goes from the top, 5000 or 6050 steps above Z0, down to Z2.
TEST(OnceWrong, TheUpperBoundDependedOnTheOrigin) {
  for (const auto& origin : {std::optional<jobs::Origin>(), std::optional<jobs::Origin>(kMidway)}) {
    EXPECT_EQ(to_string(checked("@-9,200;PU0,0;PD9,9;PU;", test_profile(), {origin, {}, {}})->summary().bounds.z),
              "-9 to 200");
  }
}

// A speed limited by an axis equals the limit except for the last digits.
TEST(OnceWrong, OneSpeedWasShownAsARange) {
  EXPECT_EQ(to_string(jobs::Reach{true, 15, 15.000000000001}), "15");
  EXPECT_EQ(to_string(jobs::Reach{true, 2, 15}), "2 to 15");
}

}  // namespace
}  // namespace axisgate::rml1
