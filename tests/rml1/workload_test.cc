// Tests of a job's demands on the tool. A step of the test mill is 0.01 mm.
#include "device/rml1/check/workload.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "tests/rml1/trace.h"

namespace axisgate::rml1 {
namespace {

std::vector<Section> sections(const std::string& job, std::optional<double> tool_mm = {}) {
  return checked(job, test_profile(), {kMidway, {}, {}, tool_mm})->sections();
}

double deepest_pass(const std::string& job) {
  double deepest = 0;
  for (const Section& one : sections(job)) deepest = std::max(deepest, one.pass_mm);
  return deepest;
}

TEST(Section, IsWhatOneSpeedCuts) {
  const auto found = sections("F4;V2;\n@-50,200;\nPU1000,0;PD3000,0;\nF8;PD3000,1000;PU;");
  ASSERT_EQ(found.size(), 3u);
  EXPECT_TRUE(found[0].plunges);
  EXPECT_EQ(found[0].speed, 2);
  EXPECT_DOUBLE_EQ(found[0].cutting_mm, 0.5);
  EXPECT_FALSE(found[1].plunges);
  EXPECT_EQ(found[1].speed, 4);
  EXPECT_EQ(found[1].first.line, 3u);
  EXPECT_DOUBLE_EQ(found[1].cutting_mm, 20);
  EXPECT_DOUBLE_EQ(found[1].deepest_mm, 0.5);
  EXPECT_EQ(found[2].speed, 8);
  EXPECT_EQ(found[2].first.line, 4u);
  EXPECT_DOUBLE_EQ(found[2].cutting_mm, 10);
}

TEST(Section, HasNoTravelAndNoLift) { EXPECT_THAT(sections("Z100,0,0;PU500,500;Z0,0,100;"), testing::IsEmpty()); }

TEST(Section, AreAFew) {
  std::string job = "@-50,200;PD;";
  for (int speed = 1; speed <= 100; ++speed)
    job += "F" + std::to_string(0.1 * speed + 1) + ";PD" + std::to_string(speed) + "00,0;";
  const auto found = sections(job);
  ASSERT_EQ(found.size(), Workload::kSections);
  EXPECT_EQ(found.back().speed, 0);
  double length = 0;
  for (const Section& one : found) length += one.cutting_mm;
  EXPECT_NEAR(length, 0.5 + 100, 1e-6);
}

TEST(Pass, OfASlotInOneGo) { EXPECT_NEAR(deepest_pass("@-300,200;PU0,0;PD3000,0;PU;"), 3, 1e-6); }

// The tool goes down without a lift between the passes, back and forth.
TEST(Pass, OfASlotInThree) {
  EXPECT_NEAR(deepest_pass("Z0,0,0;Z0,0,-100;Z3000,0,-100;Z3000,0,-200;Z0,0,-200;Z0,0,-300;Z3000,0,-300;PU;"), 1, 1e-6);
}

// Each round of 40 mm has a slope of 1 mm.
TEST(Pass, OfASlopeThatGoesRound) {
  std::string job = "Z0,0,0;";
  for (int round = 0; round < 5; ++round) {
    const int z = -100 * round;
    job += fmt::format("Z1000,0,{},1000,1000,{},0,1000,{},0,0,{};", z - 25, z - 50, z - 75, z - 100);
  }
  EXPECT_NEAR(deepest_pass(job + "PU;"), 1, 0.03);
}

TEST(Pass, OfAHoleThatIsPecked) {
  EXPECT_NEAR(deepest_pass("Z0,0,0;Z0,0,-400;Z0,0,100;Z0,0,-800;Z0,0,100;Z0,0,-1000;Z0,0,100;"), 4, 1e-6);
  EXPECT_NEAR(deepest_pass("Z0,0,0;Z0,0,-1000;Z0,0,100;"), 10, 1e-6);
}

// The slot is 20 mm long, 3 mm wide and 2 mm deep, with round ends, on cells of 0.6 mm. A second pass removes nothing.
TEST(Removed, IsTheVolumeOfTheSlot) {
  const double slot = 20 * 3 * 2 + std::numbers::pi * 1.5 * 1.5 * 2;
  const std::string job = "@-200,200;PU0,0;PD2000,0;PU;";
  const auto removed = [](const std::vector<Section>& found) {
    double sum = 0;
    for (const Section& one : found) sum += one.removed_mm3.value();
    return sum;
  };
  EXPECT_NEAR(removed(sections(job, 3)), slot, 0.05 * slot);
  EXPECT_NEAR(removed(sections(job + job, 3)), removed(sections(job, 3)), 1e-6);
  EXPECT_FALSE(sections(job)[0].removed_mm3.has_value());
}

// A grid for 0.1 mm is too fine for 1.8 m.
TEST(Removed, IsNotKnownWhereTheMapIsFull) {
  const std::string line = "@-20,200;PU0,0;PD45000,0;PU;";
  EXPECT_TRUE(sections(line, 0.1)[1].removed_mm3.has_value());
  for (const Section& one :
       sections(line + "PU0,1000;PD45000,1000;PU0,2000;PD45000,2000;PU0,3000;PD45000,3000;PU;", 0.1)) {
    EXPECT_FALSE(one.removed_mm3.has_value());
  }
}

}  // namespace
}  // namespace axisgate::rml1
