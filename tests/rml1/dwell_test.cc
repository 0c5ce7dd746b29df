// Tests of when W and !DW make the machine wait (guideline 3-1 W).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/rml1/trace.h"

namespace axisgate::rml1 {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::vector<std::string> waits(const std::string& job) { return play(job, test_profile(), kMidway).waits; }

// Counts the waits of half a second after the spindle has started.
std::size_t dwells(const std::string& job) {
  const std::vector<std::string> all = waits("Z0,0,9;W500;" + job);
  const auto count = std::count(all.begin(), all.end(), "dwell 0.5");
  EXPECT_EQ(static_cast<std::size_t>(count) + 1, all.size()) << job;
  return static_cast<std::size_t>(count);
}

TEST(Dwell, IsInMilliseconds) {
  for (const std::string command : {"W", "!DW"}) {
    EXPECT_THAT(waits("Z0,0,9;" + command + "1;PD;"), ElementsAre("spin up 2", "dwell 0.001"));
    EXPECT_THAT(waits("Z0,0,9;" + command + "32767;PD;"), ElementsAre("spin up 2", "dwell 32.767"));
    EXPECT_THAT(waits("Z0,0,9;" + command + "0;PD;"), ElementsAre("spin up 2"));
    EXPECT_THAT(waits("Z0,0,9;" + command + "1.9;PD;"), ElementsAre("spin up 2", "dwell 0.001"));
  }
}

TEST(Dwell, ComesBeforeTheToolGoesDown) {
  EXPECT_EQ(dwells("PD;"), 1u);
  EXPECT_EQ(dwells("D;"), 1u);
  EXPECT_EQ(dwells("I;"), 1u);
}

// "just before the PD tool-down operation or just before moving the XY plane": once for each command.
TEST(Dwell, ComesBeforeTheMoveInXAndYWithTheToolDown) {
  EXPECT_EQ(dwells("PD9,9;"), 1u);
  EXPECT_EQ(dwells("PD9,9;PD8,8;"), 2u);
  EXPECT_EQ(dwells("PD9,9,8,8,7,7;"), 1u);
  EXPECT_EQ(dwells("D9,9;I1,1;"), 2u);
  EXPECT_EQ(dwells("PD;PA9,9;PR1,1;"), 3u);
}

// "also performed just before changing from tool-down to tool-up with PU", and "not performed when a PU parameter
// manipulates the XY plane".
TEST(Dwell, ComesBeforeTheLiftOnly) {
  EXPECT_EQ(dwells("PU;"), 0u);
  EXPECT_EQ(dwells("PU9,9;PU8,8;M7,7;R1,1;PA5,5;"), 0u);
  EXPECT_EQ(dwells("PD;PU;"), 2u);
  EXPECT_EQ(dwells("PD;PU9,9,8,8;PU7,7;"), 2u);
  EXPECT_EQ(dwells("PD;M;"), 2u);
  EXPECT_EQ(dwells("PD;R1,1;"), 2u);
}

TEST(Dwell, ComesOnceBeforeAThreeAxisCommand) {
  EXPECT_EQ(dwells("Z1,1,1;"), 1u);
  EXPECT_EQ(dwells("Z1,1,1,2,2,2,3,3,3;"), 1u);
  EXPECT_EQ(dwells("!ZZ1,1,1,2,2,2;"), 1u);
  EXPECT_EQ(dwells("!ZZ1,1,1;Z2,2,2;"), 2u);
  EXPECT_EQ(dwells("!ZEX1:Y2:Z3;"), 1u);
}

TEST(Dwell, DoesNotComeWhereNothingIsExecuted) {
  EXPECT_EQ(dwells("Z;!ZZ;Z1,2;!ZE::;PA;PR;"), 0u);
  EXPECT_EQ(dwells("F5;V5;@-9,9;!RC1;!ZM-10;!ZO-10;DF;"), 0u);
  EXPECT_EQ(dwells("!ZEU5;"), 0u) << "an axis that the mill does not have (guideline 3-3 !ZE)";
  EXPECT_EQ(dwells("!ZEU5X1;"), 1u);
}

TEST(Dwell, IsOverAfterDfAndIn) {
  EXPECT_EQ(dwells("DF;PD;PU;"), 0u);
  EXPECT_THAT(waits("W500;IN;PD;"), ElementsAre("spin up 2"));
  EXPECT_THAT(waits("W500;H;PD;"), ElementsAre("dwell 0.5", "spin up 2"));
}

TEST(Dwell, IsNothingWithoutParameter) {
  EXPECT_EQ(dwells("W;PD;"), 0u);
  EXPECT_EQ(dwells("!DW;PD;"), 0u);
}

TEST(Dwell, StaysWhereTheParameterIsInError) {
  EXPECT_EQ(dwells("W-1;PD;"), 1u);
  EXPECT_EQ(dwells("!DW32768;PD;"), 1u);
}

TEST(Dwell, IsPartOfTheTime) {
  const Profile profile = test_profile();
  const auto without = checked("PD;PU;", profile)->summary();
  const auto with = checked("W500;PD;PU;", profile)->summary();
  EXPECT_NEAR(with.seconds_low - without.seconds_low, 1, 1e-9);
  EXPECT_NEAR(with.seconds_high - without.seconds_high, 1, 1e-9);
}

}  // namespace
}  // namespace axisgate::rml1
