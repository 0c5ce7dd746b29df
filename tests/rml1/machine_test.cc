// Tests of the modes that a command leaves in effect, and of the targets of moves (guideline 3-1 to 3-3, 5-3).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/rml1/trace.h"

namespace axisgate::rml1 {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

Played played(const std::string& job) { return play(job, test_profile(), kMidway); }

// Reports whether `job` leaves relative coordinates in effect, from the end of a three-axis move by 1, 2, -3.
bool leaves_relative(const std::string& job) {
  const jobs::Point before = played(job).final;
  const jobs::Point after = played(job + "!ZZ1,2,-3;").final;
  const bool relative = after == before + jobs::Point{1, 2, -3};
  EXPECT_NE(relative, after == (jobs::Point{1, 2, -3})) << job;
  return relative;
}

constexpr const char* kStart = "@-100,300;Z10,20,30;";

TEST(Coordinates, AreAbsoluteAtFirst) { EXPECT_FALSE(leaves_relative("!ZM-10;")); }

// Z begins at its top, which is 5000 above Z0.
TEST(Coordinates, CountFromTheWorkOriginAtFirst) {
  EXPECT_THAT(ends(played("PR;!ZZ7,5,-3;")), ElementsAre("7 5 4997"));
}

// Cutting happens below the surface, which a move can cross.
TEST(Moves, CutWithThePartBelowTheSurface) {
  const auto part = [](double from_z, double to_z) {
    Move move;
    move.from = {0, 0, from_z};
    move.to = {1000, 0, to_z};
    return move.cutting_part();
  };
  EXPECT_EQ(part(-100, -100), 1);
  EXPECT_EQ(part(-100, 0), 1);
  EXPECT_EQ(part(300, -100), 0.25);
  EXPECT_EQ(part(-100, 300), 0.25);
  EXPECT_EQ(part(300, 0), 0);
}

class LeavesAbsolute : public testing::TestWithParam<const char*> {};
TEST_P(LeavesAbsolute, WhateverWasBefore) {
  EXPECT_FALSE(leaves_relative(std::string(kStart) + "PR;" + GetParam() + ";"));
}
INSTANTIATE_TEST_SUITE_P(Group1Of53, LeavesAbsolute,
                         testing::Values("M", "M5,6", "D", "D5,6", "H", "^IN", "^PA", "^PA5,6", "^DF", "PR;PA"));

class LeavesRelative : public testing::TestWithParam<const char*> {};
TEST_P(LeavesRelative, WhateverWasBefore) {
  EXPECT_TRUE(leaves_relative(std::string(kStart) + "PA;" + GetParam() + ";"));
}
INSTANTIATE_TEST_SUITE_P(Group2Of53, LeavesRelative, testing::Values("I", "I5,6", "R", "R5,6", "^PR", "^PR5,6"));

class KeepsCoordinates : public testing::TestWithParam<const char*> {};
TEST_P(KeepsCoordinates, AbsoluteOrRelative) {
  const std::string job = std::string(GetParam()) + ";";
  EXPECT_FALSE(leaves_relative(std::string(kStart) + "PA;" + job));
  EXPECT_TRUE(leaves_relative(std::string(kStart) + "PR;" + job));
}
INSTANTIATE_TEST_SUITE_P(Groups3And4Of53, KeepsCoordinates,
                         testing::Values("PU", "PU5,6", "PD", "PD5,6", "Z", "Z5,6,7", "!ZZ", "!ZZ5,6,7", "!ZEX5Z7",
                                         "!ZE:", "!ZM", "!ZM-40", "!ZO", "!ZO-40", "@", "@-50,70", "!PZ", "!PZ-50,70",
                                         "F", "F5", "VS5", "V", "V5", "W", "W5", "!DW5", "!MC", "!MC0", "!NR", "!RC",
                                         "!RC5", "!VZ", "!VZ5"));

TEST(Coordinates, BindWhatMovesInTheSameCommand) {
  EXPECT_THAT(ends(played("@-100,300;Z10,20,300;PR;M5,6;R5,6;")), ElementsAre("10 20 300", "5 6 300", "10 12 300"));
  EXPECT_THAT(ends(played("@-100,300;Z10,20,-100;PR;D5,6;I5,6,1,1;PA7,7;PR7,7;")),
              ElementsAre("10 20 -100", "5 6 -100", "10 12 -100", "11 13 -100", "7 7 -100", "14 14 -100"));
  EXPECT_THAT(ends(played("@-100,300;Z10,20,300;PR;PU5,6;PD5,6;")),
              ElementsAre("10 20 300", "15 26 300", "15 26 -100", "20 32 -100"));
}

struct HeightAfter {
  const char* job;
  double height;
};
void PrintTo(const HeightAfter& one, std::ostream* out) { *out << one.job; }

// "When a PA or PR command is executed after execution of a group 1 command, tool-up or tool-down operation is
// performed according to the result of the group 1 command" (5-3), also if Z came between (step 2).
class ToolAfter : public testing::TestWithParam<HeightAfter> {};
TEST_P(ToolAfter, GoesToItsHeightWithPaAndPr) {
  const auto& [job, height] = GetParam();
  const std::string begin = "@-200,300;Z1,1,50;" + std::string(job) + ";PA;Z5,5,50;";
  const std::string first = fmt::format("5 5 {:g}", height);
  for (const char* plot : {"PA9,8;", "PR4,3;"}) {
    const std::vector<std::string> found = ends(played(begin + plot));
    ASSERT_GE(found.size(), 2u);
    EXPECT_EQ(found[found.size() - 2], first) << plot;
    EXPECT_EQ(found.back(), fmt::format("9 8 {:g}", height)) << plot;
  }
}
// IN sets Z2 to its default, which is the top.
INSTANTIATE_TEST_SUITE_P(Group1Of53, ToolAfter,
                         testing::Values(HeightAfter{"H", 300}, HeightAfter{"M", 300}, HeightAfter{"M2,2", 300},
                                         HeightAfter{"R", 300}, HeightAfter{"R2,2", 300}, HeightAfter{"D", -200},
                                         HeightAfter{"D2,2", -200}, HeightAfter{"I", -200}, HeightAfter{"I2,2", -200},
                                         HeightAfter{"^IN", 5000}, HeightAfter{"PU", 300}, HeightAfter{"PU2,2", 300},
                                         HeightAfter{"PD", -200}, HeightAfter{"PD2,2", -200},
                                         HeightAfter{"PU;PD", -200}, HeightAfter{"D;M", 300}));

class KeepsTool : public testing::TestWithParam<const char*> {};
TEST_P(KeepsTool, UpOrDown) {
  const std::string job = std::string(GetParam()) + ";!PZ-200,300;PA;Z5,5,50;PA9,9;";
  EXPECT_EQ(played("!PZ-200,300;PD;" + job).final.z, -200);
  EXPECT_EQ(played("!PZ-200,300;PU;" + job).final.z, 300);
  EXPECT_EQ(played(job).final.z, 300) << "the tool default for PA and PR is the raised status (5-3)";
}
INSTANTIATE_TEST_SUITE_P(Group3Of53, KeepsTool,
                         testing::Values("F5", "VS5", "V5", "W5", "Z1,1,1", "!ZZ1,1,1", "!ZEZ1", "DF", "!DW5", "!MC0",
                                         "!MC1", "!ZO-5000", "!ZM-4000", "PA", "PR", "PA3,3", "PR3,3"));

TEST(Tool, PaAndPrWithoutParametersMoveNothing) {
  EXPECT_THAT(ends(played("Z0,0,50;PA;PR;PA;")), ElementsAre("0 0 50"));
}

// Heights to which PD and PU go after a job (3-3 !PZ, 3-1 @).
struct HeightsAfter {
  const char* job;
  double z1, z2;
  const char* diagnostic = "";
};
void PrintTo(const HeightsAfter& one, std::ostream* out) { *out << one.job; }

class Heights : public testing::TestWithParam<HeightsAfter> {};
TEST_P(Heights, AreSet) {
  for (const std::string command : {"@", "!PZ"}) {
    std::string job;
    for (const char* c = GetParam().job; *c != 0; ++c) job += *c == '@' ? command : std::string(1, *c);
    const Played found = played("Z0,0,7;" + job + "PD;PU;");
    EXPECT_THAT(ends(found),
                ElementsAre("0 0 7", fmt::format("0 0 {:g}", GetParam().z1), fmt::format("0 0 {:g}", GetParam().z2)))
        << job;
    const std::vector<std::string> diagnostics = told(found.diagnostics);
    if (*GetParam().diagnostic == 0) {
      EXPECT_THAT(diagnostics, IsEmpty()) << job;
    } else {
      EXPECT_EQ(diagnostics.size(), 1u) << job;
      EXPECT_EQ(diagnostics.at(0).substr(0, 7), GetParam().diagnostic) << job;
    }
  }
}
// Defaults: Z1 -100, Z2 the top, 5000. The work area ends at -1050.
INSTANTIATE_TEST_SUITE_P(
    Z1AndZ2, Heights,
    testing::Values(HeightsAfter{"", -100, 5000}, HeightsAfter{"@-200,300;", -200, 300},
                    HeightsAfter{"@-50,300;@-200;", -200, 300}, HeightsAfter{"@-200,300;@;", -100, 5000},
                    HeightsAfter{"@0,0;@-1,1;", -1, 1}, HeightsAfter{"@5,300;", -100, 300, "error 3"},
                    HeightsAfter{"@-200,-5;", -200, 5000, "error 3"},
                    HeightsAfter{"@-200,300;@5;", -200, 300, "error 3"}, HeightsAfter{"@-1050;", -1050, 5000},
                    HeightsAfter{"@-1051,300;", -100, 300, "error 3"},
                    HeightsAfter{"@-200,300;@-1051;", -200, 300, "error 3"}, HeightsAfter{"@-200,9000;", -200, 5000},
                    HeightsAfter{"@-200.9,300.9;", -200, 300}));

TEST(Heights, Z0ItselfIsAHeightForBoth) { EXPECT_THAT(ends(played("@0,0;PD;")), ElementsAre("0 0 0")); }

TEST(Heights, BothInErrorAreBothKept) {
  const Played found = played("@-200,300;@5,-5;PD;PU;");
  EXPECT_THAT(ends(found), ElementsAre("0 0 -200", "0 0 300"));
  EXPECT_THAT(told(found.diagnostics), ElementsAre("error 3 at 11", "error 3 at 13"));
}

// "Z2 can be set outside the cutting range, and its value is retained. If Z0 is lowered so that Z2 comes within the
// effective range, its value is used" (3-2 PU). The top is 6000 above the new Z0.
TEST(Heights, Z2AboveTheTopIsRetained) {
  EXPECT_THAT(ends(played("@-200,5500;PU;!ZO-6000;PU;")), ElementsAre("0 0 5500"));
}

TEST(Heights, XAndYMoveAtTheTopWhereZ2IsAbove) {
  EXPECT_THAT(ends(played("@-100,9000;PD;PU100,0;PD200,0;")),
              ElementsAre("0 0 -100", "0 0 5000", "100 0 5000", "100 0 -100", "200 0 -100"));
}

// 162.6 occurred in a real job. A place is rounded to the nearest step.
TEST(Places, AreRoundedToTheStep) {
  EXPECT_THAT(ends(played("Z162.6,-162.6,10.4;")), ElementsAre("163 -163 10"));
  EXPECT_THAT(ends(played("@-10,20;Z0,0,20;M0.4,99.9;")), ElementsAre("0 0 20", "0 100 20"));
}

// 0.4, 0.8, 1.2, 1.6: the first rounds to no move, the third to the place of the second.
TEST(Places, SumsAreNotRounded) {
  EXPECT_THAT(ends(played("PR0.4,0,0.4,0,0.4,0,0.4,0;")), ElementsAre("1 0 5000", "2 0 5000"));
  EXPECT_THAT(ends(played("PR;Z0,0,-0.4;Z0,0,-0.4;!ZEZ-0.4;!ZEZ-0.4;")), ElementsAre("0 0 4999", "0 0 4998"));
}

// The command leads to 5000 + 4000; 1000 down is 8000, and 4000 more is 4000.
TEST(Places, RelativeMotionCountsFromTheCommandedPlace) {
  EXPECT_THAT(ends(played("PR;Z0,0,4000;Z0,0,-1000;")), IsEmpty());
  EXPECT_EQ(text(played("PR;Z0,0,4000;Z0,0,-1000;Z0,0,-4000;").final), "0 0 4000");
}

// "Reset the coordinate values. The present position of the tool is the same" (3-2 IN, 3-1 H).
TEST(Places, InAndHResetTheCommandedPlace) {
  EXPECT_EQ(text(played("Z0,0,9000;IN;PR;Z0,0,-1000;").final), "0 0 4000");
  EXPECT_EQ(text(played("Z0,0,9000;H;PR;Z0,0,-1000;").final), "0 0 4000");
}

TEST(Home, LiftsToTheTopThenGoesToTheOrigin) {
  EXPECT_THAT(ends(played("Z10,20,30;H;")), ElementsAre("10 20 30", "10 20 5000", "0 0 5000"));
}

TEST(Home, ChangesNoSetting) {
  const Profile profile = test_profile();
  const auto check = checked("F5;V6;@-200,300;!ZO-4000;PR;PD;H;", profile, {kMidway, {}, {}});
  EXPECT_EQ(check->machine().cutting_speed(), 5);
  EXPECT_EQ(check->machine().z_speed(), 6);
  EXPECT_EQ(check->machine().z1(), -200);
  EXPECT_EQ(check->machine().z2(), 300);
  EXPECT_EQ(check->machine().box().highest.z, 4000);
  EXPECT_FALSE(check->machine().tool_lowered());
}

// "If the workpiece-coordinate origin point is outside the cutting range, then this moves, for example, to the clip
// location" (3-1 H). X begins at 1000, Y at -500: 1000 0 is the nearest place.
TEST(Home, GoesToTheNearestPlaceWhereTheOriginIsOutside) {
  const Played found = play("Z2000,100,30;H;PR;Z5,0,-10;", test_profile(), jobs::Origin{-10, 5, 50});
  const std::vector<std::string> all = ends(found);
  ASSERT_GE(all.size(), 3u);
  EXPECT_THAT(std::vector(all.end() - 3, all.end()), ElementsAre("2000 100 5000", "1000 0 5000", "1005 0 4990"));
}

TEST(Initialize, DoesWhatDfDoesAndRaisesTheTool) {
  const Profile profile = test_profile();
  const auto check = checked("F5;V6;W70;@-200,300;!MC0;PR;Z10,20,-5050;PD;IN;", profile, {kMidway, {}, {}});
  const Machine& machine = check->machine();
  EXPECT_EQ(machine.cutting_speed(), 2);
  EXPECT_EQ(machine.z_speed(), 2);
  EXPECT_EQ(machine.z1(), -100);
  EXPECT_EQ(machine.z2(), 5000);
  EXPECT_FALSE(machine.tool_lowered());
  EXPECT_EQ(text(machine.tool()), "10 20 5000");
}

TEST(Initialize, KeepsZ0) { EXPECT_EQ(played("!ZO-4000;IN;").box.highest.z, 4000); }

TEST(Initialize, GoesToTheProfilesZ2) {
  Profile profile = test_profile();
  profile.default_z2 = 250;
  EXPECT_THAT(ends(play("@-100,300;PD;IN;", profile, kMidway)), ElementsAre("0 0 -100", "0 0 250"));
}

TEST(Defaults, MoveNothing) {
  const Played found = played("@-200,300;PD;DF;");
  EXPECT_THAT(ends(found), ElementsAre("0 0 -200"));
  EXPECT_THAT(ends(played("@-200,300;PD;DF;PA9,9;")), ElementsAre("0 0 -200", "0 0 -100", "9 9 -100"));
}

TEST(Defaults, AreThoseOfTheProfile) {
  Profile profile = test_profile();
  profile.default_z1 = -30;
  profile.default_z2 = 250;
  const auto check = checked("F5;V6;@-200,300;DF;", profile, {kMidway, {}, {}});
  EXPECT_EQ(check->machine().cutting_speed(), 2);
  EXPECT_EQ(check->machine().z_speed(), 2);
  EXPECT_EQ(check->machine().z1(), -30);
  EXPECT_EQ(check->machine().z2(), 250);
}

}  // namespace
}  // namespace axisgate::rml1
