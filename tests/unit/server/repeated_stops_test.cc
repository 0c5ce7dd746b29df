// A loop of stops is reported once and counted; a stop by another caller, or one that found something moving, is always
// reported.
#include "server/devices/repeated_stops.h"

#include <gtest/gtest.h>

namespace axisgate::server::repeated_stops_test {
namespace {

using stage::AxisSet;
using stage::StopRequested;
using std::chrono::milliseconds;
using std::chrono::seconds;

class RepeatedStopsTest : public testing::Test {
 protected:
  std::vector<StopRequested> stop(const std::string& who, bool moved = false, AxisSet axes = AxisSet::first(3)) {
    now_ += milliseconds(1);
    return stops_.add({.axes = axes, .who = who, .moved = moved}, now_);
  }

  RepeatedStops stops_;
  TimePoint now_{seconds(1000)};
};

TEST_F(RepeatedStopsTest, ALoopIsReportedOnceAndCountedAtItsEnd) {
  ASSERT_EQ(stop("unix olaf").size(), 1u);
  for (int i = 0; i < 1500; ++i) ASSERT_TRUE(stop("unix olaf").empty()) << i;
  EXPECT_TRUE(stops_.folds("unix olaf"));
  EXPECT_TRUE(stops_.ended(now_ + seconds(10)).empty());
  const auto counts = stops_.ended(now_ + seconds(11));
  ASSERT_EQ(counts.size(), 1u);
  EXPECT_EQ(counts.front().count, 1500);
  EXPECT_EQ(counts.front().who, "unix olaf");
  EXPECT_FALSE(stops_.folds("unix olaf"));
}

TEST_F(RepeatedStopsTest, TwoWhoTakeTurnsAreTwoSeries) {
  EXPECT_EQ(stop("unix olaf").size(), 1u);
  EXPECT_EQ(stop("tcp 127.0.0.1:1").size(), 1u);
  for (int i = 0; i < 100; ++i) {
    EXPECT_TRUE(stop("unix olaf").empty());
    EXPECT_TRUE(stop("tcp 127.0.0.1:" + std::to_string(i)).empty()) << "anonymous callers count as one";
  }
  EXPECT_EQ(stop("unix anna").size(), 1u) << "another caller is never folded";
  EXPECT_EQ(stop("unix olaf", false, AxisSet::of(1)).size(), 1u) << "nor is another stop";
}

TEST_F(RepeatedStopsTest, AStopThatFoundSomethingMovingIsReported) {
  EXPECT_EQ(stop("unix olaf").size(), 1u);
  EXPECT_TRUE(stop("unix olaf").empty());
  const auto reported = stop("unix olaf", true);
  ASSERT_EQ(reported.size(), 2u);
  EXPECT_EQ(reported.front().count, 1) << "the one that was folded before";
  EXPECT_TRUE(reported.back().moved);
  EXPECT_EQ(stop("unix olaf", true).size(), 1u);
}

TEST_F(RepeatedStopsTest, ASeriesThatLastsIsReportedAgain) {
  EXPECT_EQ(stop("unix olaf").size(), 1u);
  int reported = 0;
  for (int i = 0; i < 200; ++i) {
    now_ += seconds(9);
    reported += static_cast<int>(stop("unix olaf").size());
  }
  EXPECT_EQ(reported, 2) << "half an hour";
}

}  // namespace
}  // namespace axisgate::server::repeated_stops_test
