// Tests of the speed of a move (guideline 3-1 F and V, 3-2 VS and PU, 3-3 !VZ).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/rml1/trace.h"

namespace axisgate::rml1 {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;

// Returns a mill whose figures all differ: travel 30, Z at most 10; F from 0.5 to 20, default 3; V from 0.25 to 25,
// default 4.
Profile mill() {
  Profile profile = test_profile();
  profile.speed = {30, 10, 0.5, 20, 3, 0.25, 25, 4};
  return profile;
}

std::vector<double> speeds(const std::string& job, const Profile& profile = mill()) {
  std::vector<double> found;
  for (const Move& move : play(job, profile, kMidway).moves) found.push_back(move.speed);
  return found;
}

struct Set {
  const char* job;
  double speed;
  const char* diagnostic = "";
};
void PrintTo(const Set& one, std::ostream* out) { *out << one.job; }

std::string first_told(const Check& check) {
  const auto& kept = check.diagnostics().kept();
  return kept.empty() ? "" : fmt::format("{} {}", name(kept[0].severity), kept[0].number);
}

class CuttingSpeed : public testing::TestWithParam<Set> {};
TEST_P(CuttingSpeed, IsClampedToTheProfile) {
  const Profile profile = mill();
  for (const std::string command : {"F", "VS"}) {
    const auto check = checked("VS7;" + command + GetParam().job + ";", profile);
    EXPECT_EQ(check->machine().cutting_speed(), GetParam().speed) << command;
    EXPECT_EQ(check->machine().z_speed(), 4) << command;
    EXPECT_EQ(first_told(*check), GetParam().diagnostic) << command;
  }
}
// "No error is generated": a value beyond the machine or the type is limited, with a warning (2-5).
INSTANTIATE_TEST_SUITE_P(FAndVs, CuttingSpeed,
                         testing::Values(Set{"", 3}, Set{"5", 5}, Set{"0.7", 0.7}, Set{"0", 0.5}, Set{"-3", 0.5},
                                         Set{"20", 20}, Set{"20.1", 20, "warning 0"}, Set{"32767", 20, "warning 0"},
                                         Set{"32768", 20, "warning 0"}, Set{"-32769", 0.5, "warning 0"}));

class HeightSpeed : public testing::TestWithParam<Set> {};
TEST_P(HeightSpeed, IsClampedToTheProfile) {
  const Profile profile = mill();
  for (const std::string command : {"V", "!VZ"}) {
    const auto check = checked("!VZ7;" + command + GetParam().job + ";", profile);
    EXPECT_EQ(check->machine().z_speed(), GetParam().speed) << command;
    EXPECT_EQ(check->machine().cutting_speed(), 3) << command;
    EXPECT_EQ(first_told(*check), GetParam().diagnostic) << command;
  }
}
// "An out-of-range parameter results in error 3", and the speed is not set.
INSTANTIATE_TEST_SUITE_P(VAndVz, HeightSpeed,
                         testing::Values(Set{"", 4}, Set{"5", 5}, Set{"0.3", 0.3}, Set{"0", 0.25}, Set{"-3", 0.25},
                                         Set{"25.1", 25, "warning 0"}, Set{"32767", 25, "warning 0"},
                                         Set{"32768", 7, "error 3"}, Set{"-32769", 7, "error 3"}));

TEST(Speed, IsTheDefaultAtFirst) {
  const Profile profile = mill();
  EXPECT_EQ(checked("", profile)->machine().cutting_speed(), 3);
  EXPECT_EQ(checked("", profile)->machine().z_speed(), 4);
}

TEST(Speed, OfCuttingIsFInXAndYAndVInZ) {
  for (const char* job : {"F7;V6;PD99,0;", "F7;V6;D99,0;", "F7;V6;I99,0;"}) {
    EXPECT_THAT(speeds(job), ElementsAre(6, 7)) << job;
  }
  EXPECT_THAT(speeds("F7;V6;PD;PA99,0;PR9,0;"), ElementsAre(6, 7, 7));
}

// "PU operates at a particular specified speed, regardless of the VS command". M and R run at the model's highest
// speed.
TEST(Speed, OfTravelIsTheProfiles) {
  for (const char* job : {"@-9,900;F7;V6;PU99,0;", "@-9,900;F7;V6;M99,0;", "@-9,900;F7;V6;R99,0;",
                          "@-9,900;F7;V6;PA99,0;", "@-9,900;F7;V6;PR99,0;"}) {
    EXPECT_THAT(speeds(job), ElementsAre(6, 30)) << job;
  }
}

TEST(Speed, OfThreeAxesIsV) {
  EXPECT_THAT(speeds("F7;V6;Z300,0,4600;!ZZ400,0,4600;!ZEX500;!ZEZ0;!ZM-400;"), ElementsAre(6, 6, 6, 6, 6));
}

TEST(Speed, OfHomeIsTheHighest) { EXPECT_THAT(speeds("V6;Z99,0,0;H;"), ElementsAre(6, 10, 30)); }

// V is 25. Z alone runs at 10. With sides 3, 4 and 5, Z runs at 10 if the move runs at 12.5. X and Y alone run at 25.
TEST(Speed, IsNoMoreThanTheAxesHighest) {
  EXPECT_THAT(speeds("V25;Z0,0,4900;PR;Z300,0,-400;Z300,400,0;"),
              ElementsAre(DoubleEq(10), DoubleEq(12.5), DoubleEq(25)));
}

// X and Y reach 30, Z 10: on a slope of 1 in 10 the XY plane is the limit, 30 * sqrt(1.01).
TEST(Speed, OfThePlaneIsNoMoreThanItsHighest) {
  Profile profile = mill();
  profile.speed.z_maximum = 100;
  EXPECT_THAT(speeds("V100;PR;Z1000,0,0;Z1000,0,-100;", profile),
              ElementsAre(DoubleEq(30), DoubleEq(30 * std::sqrt(1.01))));
}

// "move only the X and Y axes at the speed set by the !ZZ command" (5-1 J). The bottom is at -1050.
TEST(Speed, AtTheBottomIsV) { EXPECT_THAT(speeds("F7;V6;Z0,0,-2000;Z99,0,-2000;"), ElementsAre(6, 6)); }

}  // namespace
}  // namespace axisgate::rml1
