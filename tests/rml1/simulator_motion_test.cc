// Tests of the simulated mill's moves and their durations, computed by hand from the guideline and the figures of
// test_profile(): steps of 0.01 mm, travel 15 mm/s, cutting and Z 2 mm/s until they are set, a spin-up of 2 s.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/rml1/simulator_bench.h"

namespace axisgate::rml1::simulator::motion_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr double kMs = 0.001;

TEST(MillMotion, TravelsAtTheProfilesSpeedAfterTheSpinUp) {
  MillBench bench;
  EXPECT_NEAR(bench.time_ms("PU1500,0;"), 2000 + 1000, kMs);
  EXPECT_NEAR(bench.time_ms("PU0,0;"), 1000, kMs);
  EXPECT_EQ(bench.tool(), "0 0 5000");
}

TEST(MillMotion, CutsAtFAndLowersAtV) {
  MillBench bench;
  // 5000 + 100 steps down, then 1000 along X.
  EXPECT_NEAR(bench.time_ms("!MC0;V5;F4;PD1000,0;"), 10200 + 2500, kMs);
  EXPECT_EQ(bench.tool(), "1000 0 -100");
}

TEST(MillMotion, GoesStraightInThreeAxes) {
  MillBench bench;
  // 30 mm, 40 mm and no change of height.
  EXPECT_NEAR(bench.time_ms("!MC0;V10;Z3000,4000,5000;"), 5000, kMs);
  bench.send("PR;Z0,0,-1000;");
  bench.finish();
  EXPECT_EQ(bench.tool(), "3000 4000 4000");
}

TEST(MillMotion, IsSlowerByPercentOfTheTime) {
  MillSetup setup;
  setup.slower_percent = 10;
  MillBench bench(setup);
  EXPECT_NEAR(bench.time_ms("PU1500,0;"), 2000 + 1100, kMs);
}

TEST(MillMotion, AcceleratesWhereSoSet) {
  // 15 mm at 15 mm/s with 200 mm/s2: 75 ms more; with 100: 150 ms more.
  MillBench best(with_options({{"acceleration", "best"}})), worst(with_options({{"acceleration", "worst"}}));
  EXPECT_NEAR(best.time_ms("!MC0;PU1500,0;"), 1075, kMs);
  EXPECT_NEAR(worst.time_ms("!MC0;PU1500,0;"), 1150, kMs);
  // Half a millimetre is too short to reach the speed: twice the root of 0.5 / 200.
  EXPECT_NEAR(best.time_ms("PU1550,0;"), 100, kMs);
}

TEST(MillMotion, AcceleratesAlsoUpToWhereItIsEnded) {
  MillBench bench(with_options({{"acceleration", "best"}, {"escape_k", "one-shot"}}));
  bench.send("!MC0;PU1500,0;");
  bench.wait_ms(50);
  // 200 / 2 * 0.05 squared is 0.25 mm.
  EXPECT_EQ(bench.tool(), "25 0 5000");
  bench.wait_ms(1000);
  // 25 ms before the end: 1500 steps less 200 / 2 * 0.025 squared.
  EXPECT_EQ(bench.tool(), "1493.75 0 5000");
}

TEST(MillMotion, DwellsOncePerCommandOrPerPoint) {
  // 50 mm and 1 mm down at 2 mm/s, and three edges of 2 mm at 2 mm/s.
  const std::string job = "!MC0;W500;PD200,0,200,200,0,200;";
  MillBench once, each(with_options({{"dwell_per", "point"}}));
  EXPECT_NEAR(once.time_ms(job), 500 + 25500 + 3000, kMs);
  EXPECT_NEAR(each.time_ms(job), 3 * 500 + 25500 + 3000, kMs);
}

TEST(MillMotion, LiftsAndStopsTheSpindleAtIn) {
  MillBench bench;
  bench.send("PD1000,0;^IN;");
  bench.finish();
  EXPECT_EQ(bench.tool(), "1000 0 5000");
  EXPECT_THAT(bench.recorded("spindle"), ElementsAre("\"spindle\":6500", "\"spindle\":0"));
}

TEST(MillMotion, GoesToTheTopAndThenToTheOriginAtH) {
  MillBench bench;
  bench.send("!MC0;PD300,400;");
  bench.finish();
  bench.lines.clear();
  bench.send("H;");
  bench.finish();
  EXPECT_THAT(bench.recorded("command"), ElementsAre(testing::StartsWith("\"command\":\"H\"")));
  const auto paths = bench.recorded("path");
  ASSERT_EQ(paths.size(), 2u);
  EXPECT_THAT(paths[0], testing::EndsWith("\"path\":[[10300,10400,-5100],[10300,10400,0]]"));
  EXPECT_THAT(paths[1], testing::EndsWith("\"path\":[[10300,10400,0],[10000,10000,0]]"));
}

// Guideline 5-1 C: the path leaves at one side and returns at another.
TEST(MillMotion, WaitsAtTheEdgeAndReturnsOverTheTop) {
  MillBench bench;
  bench.send("!MC0;PD-9000,0;");
  bench.finish();
  bench.lines.clear();
  bench.send("D-11000,0;");
  bench.finish();
  EXPECT_EQ(bench.tool(), "-10000 0 -100");
  bench.send("D-11000,5000;");
  bench.finish();
  EXPECT_EQ(bench.tool(), "-10000 0 -100");
  bench.send("D-9000,5000;");
  bench.finish();
  std::vector<std::string> paths = bench.recorded("path");
  for (std::string& path : paths) path = path.substr(path.find("\"path\""));
  EXPECT_THAT(paths, ElementsAre("\"path\":[[1000,10000,-5100],[0,10000,-5100]]",  // to the edge
                                 "\"path\":[[0,10000,-5100],[0,10000,0]]",         // raised
                                 "\"path\":[[0,10000,0],[0,15000,0]]",      // to the place where the path returns
                                 "\"path\":[[0,15000,0],[0,15000,-5100]]",  // lowered
                                 "\"path\":[[0,15000,-5100],[1000,15000,-5100]]"));
}

// 5-1 F and J: above the top and below the bottom only X and Y move.
TEST(MillMotion, StaysAtTheTopAndAtTheBottom) {
  MillBench bench;
  bench.send("!MC0;Z1000,0,6000;");
  bench.finish();
  EXPECT_EQ(bench.tool(), "1000 0 5000");
  bench.send("Z2000,0,-3000;");
  bench.finish();
  EXPECT_EQ(bench.tool(), "2000 0 -1050");
  bench.send("PR;Z0,0,1000;");  // from the commanded -3000
  bench.finish();
  EXPECT_EQ(bench.tool(), "2000 0 -1050");
}

TEST(MillMotion, BendsWhereTheLineCrossesTheTop) {
  MillBench bench;
  bench.send("!MC0;Z0,0,4000;");
  bench.finish();
  bench.lines.clear();
  bench.send("Z1000,0,6000;");
  bench.finish();
  const auto paths = bench.recorded("path");
  ASSERT_EQ(paths.size(), 2u);
  EXPECT_THAT(paths[0], testing::EndsWith("\"path\":[[10000,10000,-1000],[10500,10000,0]]"));
  EXPECT_THAT(paths[1], testing::EndsWith("\"path\":[[10500,10000,0],[11000,10000,0]]"));
}

TEST(MillMotion, IsHeldBackByZ) {
  MillSetup setup;
  setup.profile = test_profile();
  setup.profile.speed.travel_z = 2;
  MillBench bench(setup);
  // 30 mm along X and 40 mm of Z at 2 mm/s.
  EXPECT_NEAR(bench.time_ms("!MC0;V15;Z3000,0,1000;"), 20000, kMs);
}

TEST(MillMotion, HoldsFlatCommandsAtTheEdgeWhereTheProfileSaysSo) {
  MillSetup setup;
  setup.profile = test_profile();
  setup.profile.holds_flat_commands = true;
  MillBench bench(setup);
  bench.send("!MC0;M-20000,0,-20000,500;");
  bench.finish();
  EXPECT_EQ(bench.tool(), "-10000 500 5000");
}

TEST(MillMotion, TurnsTheRotaryAxisByDegrees) {
  MillBench bench;
  EXPECT_NEAR(bench.time_ms("!MC0;!ZEA90;"), 9000, kMs);
  EXPECT_NEAR(bench.time_ms("PR;!ZEA-30;"), 3000, kMs);
  EXPECT_THAT(bench.recorded("turn"), ElementsAre("\"turn\":90", "\"turn\":-30"));
}

TEST(MillMotion, KnowsTheAngleAtWhichATurnWasEnded) {
  MillBench bench(with_options({{"escape_k", "one-shot"}}));
  bench.send("!MC0;!ZEA90;");
  bench.wait_ms(4000);
  bench.send("\x1B.K!ZEA45;");
  bench.finish();
  EXPECT_THAT(bench.recorded("turn"), ElementsAre("\"turn\":40", "\"turn\":5"));
}

TEST(MillMotion, ReadsHundredthsOfADegreeWithoutPoint) {
  MillSetup setup;
  setup.profile = test_profile();
  setup.profile.rotary->hundredths = true;
  MillBench bench(setup);
  bench.send("!MC0;!ZEA100;!ZEA3.0;");
  bench.finish();
  EXPECT_THAT(bench.recorded("turn"), ElementsAre("\"turn\":1", "\"turn\":2"));
}

TEST(MillMotion, DoesNotMoveForPaAndPrWithoutNumbers) {
  MillBench bench;
  bench.send("PD;");
  bench.finish();
  bench.lines.clear();
  bench.send("PA;PR;DF;F3;V3;!RC5;@-50,200;");
  bench.finish();
  EXPECT_THAT(bench.recorded("path"), IsEmpty());
}

TEST(MillMotion, SetsTheSpindleByStageAndDirectly) {
  MillSetup setup;
  setup.profile = test_profile();
  setup.profile.spindle = {Spindle::Law::direct, 400, 12000, 400, 773, 2};
  MillBench bench(setup);
  // 400 + 773 n rpm up to stage 15, direct from 100 on (guideline 3-3 !RC).
  bench.send("!RC2;PU;!RC99;!RC3124;!RC20000;!RC100;!RC-1;!RC;");
  bench.finish();
  EXPECT_THAT(bench.recorded("spindle"), ElementsAre("\"spindle\":1946", "\"spindle\":11995", "\"spindle\":3124",
                                                     "\"spindle\":12000", "\"spindle\":400"));
  EXPECT_EQ(bench.errors(), "3");
}

TEST(MillMotion, IgnoresRcWhereTheSpindleHasOneSpeed) {
  MillBench bench;
  bench.send("PU;!RC3;");
  bench.finish();
  EXPECT_THAT(bench.recorded("spindle"), ElementsAre("\"spindle\":6500"));
}

TEST(MillMotion, SetsZ0FromTheMachineCoordinate) {
  MillBench bench;
  bench.send("!MC0;!ZO-1000;PD;");
  bench.finish();
  EXPECT_EQ(bench.tool(), "0 0 -100");
  bench.send("!ZM-2000;");
  bench.finish();
  EXPECT_EQ(bench.tool(), "0 0 -1000");
  bench.send("!ZM-6051;!ZM1;!ZO1;");  // the travel is 6050 steps
  bench.finish();
  EXPECT_EQ(bench.tool(), "0 0 -1000");
  EXPECT_THAT(bench.recorded("error"), ElementsAre("\"error\":3", "\"error\":3", "\"error\":3"));
}

}  // namespace
}  // namespace axisgate::rml1::simulator::motion_test
