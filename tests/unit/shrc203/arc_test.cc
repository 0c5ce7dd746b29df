// Arcs and helices (manual 71) to 82)): the manual's examples, arcs with closed-form results, and arcs that are
// refused.
#include "device/shrc203/planning/arc.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

namespace axisgate::shrc203::arc_test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::int64_t kFurthest = 999'999'999;

std::string text(const ArcExtent& extent) {
  return fmt::format("[{} {}] [{} {}] [{} {}]", extent.first.lowest, extent.first.highest, extent.second.lowest,
                     extent.second.highest, extent.third.lowest, extent.third.highest);
}

Reason reason_of(const Result<Arc>& arc) { return arc ? Reason::unspecified : arc.error().reason; }

TEST(Arc, TheManualsCircle) {
  // Manual 71): 0.05 mm and -0.05 mm at 10 nm a pulse.
  const Arc arc = whole_circle({5000, -5000}, Rotation::clockwise);
  EXPECT_EQ(end_of(arc), ArcEnd{});
  EXPECT_EQ(text(extent_of(arc)), "[-2072 12072] [-12072 2072] [0 0]");
  EXPECT_DOUBLE_EQ(length_of(arc), 2 * kPi * 5000 * std::numbers::sqrt2);
}

TEST(Arc, TheManualsAngle) {
  // Manual 72): from 100 pulses left of and 200 above the center, over the top, to 200 right of and 100 above it.
  const auto arc = arc_by_angle({100, -200}, 90, Rotation::clockwise);
  ASSERT_TRUE(arc);
  EXPECT_EQ(end_of(*arc), (ArcEnd{300, -100, 0}));
  EXPECT_EQ(text(extent_of(*arc)), "[0 300] [-100 24] [0 0]");
  const auto back = arc_by_angle({100, -200}, 90, Rotation::counterclockwise);
  ASSERT_TRUE(back);
  EXPECT_EQ(end_of(*back), (ArcEnd{-100, -300, 0}));
}

// Three of the manual's four examples of passing points run clockwise, although all four have direction 0.
TEST(Arc, TheManualsPassingPoints) {
  EXPECT_EQ(rotation_of(*arc_through({5000, 3000}, {8000, 12000})), Rotation::counterclockwise);  // 73), 79)
  EXPECT_EQ(rotation_of(*arc_through({-5000, 3000}, {-8000, 12000})), Rotation::clockwise);       // 76), 82)
  EXPECT_EQ(rotation_of(*arc_through({100, 150}, {500, 200})), Rotation::clockwise);              // 114) (5)
  EXPECT_EQ(rotation_of(*arc_through({-100, 50}, {-150, 100})), Rotation::clockwise);             // 114) (8)
}

TEST(Arc, WholePulsesAreNotRoundedFurther) {
  EXPECT_EQ(text(extent_of(whole_circle({0, 5000}, Rotation::clockwise))), "[-5000 5000] [0 10000] [0 0]");
  EXPECT_EQ(text(extent_of(whole_circle({-3, 4}, Rotation::counterclockwise))), "[-8 2] [-1 9] [0 0]");
  EXPECT_EQ(text(extent_of(whole_circle({599999997, 799999996}, Rotation::clockwise))),
            "[-399999998 1599999992] [-199999999 1799999991] [0 0]");
}

TEST(Arc, ItsExtentBeginsBeforeAnAxisTurnsBack) {
  const auto extent = [](double degrees, Rotation way) {
    return text(extent_of(*arc_by_angle({-1000000, 0}, degrees, way)));
  };
  // From the rightmost point: the second axis turns back after 90 degrees, the first after 180.
  EXPECT_EQ(extent(89, Rotation::counterclockwise), "[-982548 0] [0 999848] [0 0]");
  EXPECT_EQ(extent(91, Rotation::counterclockwise), "[-1017453 0] [0 1000000] [0 0]");
  EXPECT_EQ(extent(181, Rotation::counterclockwise), "[-2000000 0] [-17453 1000000] [0 0]");
  EXPECT_EQ(extent(181, Rotation::clockwise), "[-2000000 0] [-1000000 17453] [0 0]");
  EXPECT_EQ(extent(271, Rotation::clockwise), "[-2000000 0] [-1000000 1000000] [0 0]");
}

TEST(Arc, PointsOnOneLineAreNoArc) {
  for (const auto& [passing, end] : {std::pair{PlanePoint{5000, 3000}, PlanePoint{10000, 6000}},
                                     {PlanePoint{10, 10}, PlanePoint{-20, -20}},
                                     {PlanePoint{20, 20}, PlanePoint{10, 10}},
                                     {PlanePoint{0, 7}, PlanePoint{0, 9}},
                                     {PlanePoint{kFurthest, -kFurthest}, PlanePoint{-kFurthest, kFurthest}}}) {
    EXPECT_EQ(reason_of(arc_through(passing, end)), Reason::invalid_request) << passing.first << ' ' << end.first;
  }
  EXPECT_EQ(arc_through({5000, 3000}, {10000, 6000}).error().message,
            "the start, (5000, 3000) and (10000, 6000), in pulses from it, lie on one line: no arc leads through the "
            "three points (manual 73) E:2)");
}

TEST(Arc, ThreeDifferentPointsAreNeeded) {
  EXPECT_EQ(reason_of(arc_through({0, 0}, {10, 5})), Reason::invalid_request) << "passing where it starts";
  EXPECT_EQ(reason_of(arc_through({10, 5}, {10, 5})), Reason::invalid_request) << "passing where it ends";
  EXPECT_EQ(reason_of(arc_through({10, 5}, {0, 0})), Reason::invalid_request) << "ending where it starts";
  EXPECT_EQ(reason_of(arc_through({0, 0}, {0, 0})), Reason::invalid_request);
  EXPECT_EQ(reason_of(helix_through({10, 5}, {20, 10}, 5)), Reason::invalid_request);
}

// The calculation must be exact: the products of coordinates have more digits than a double.
TEST(Arc, NearlyOnOneLine) {
  const auto flat = arc_through({499'999'999, 1}, {999'999'999, 1});
  ASSERT_TRUE(flat) << flat.error().message;
  EXPECT_EQ(end_of(*flat), (ArcEnd{999'999'999, 1, 0}));
  EXPECT_EQ(extent_of(*flat).first, (Extent{0, 999'999'999}));
  EXPECT_EQ(extent_of(*flat).second, (Extent{0, 2})) << "it is highest a little above 1, at three quarters";
  EXPECT_NEAR(length_of(*flat), 999'999'999, 1);
  const auto steep = arc_through({333'333'333, 333'333'332}, {999'999'999, 999'999'998});
  ASSERT_TRUE(steep);
  EXPECT_EQ(rotation_of(*steep), Rotation::counterclockwise);
  EXPECT_EQ(end_of(*steep), (ArcEnd{999'999'999, 999'999'998, 0}));
  EXPECT_EQ(text(extent_of(*steep)), "[0 999999999] [0 999999998] [0 0]");
  EXPECT_GT(steep->radius, 1e17);
}

TEST(Arc, OnesThatLeadOutOfEverythingAreRefused) {
  // The arc runs from the start through a point far beyond the end: nearly a full circle, too large for any stage.
  const auto around_it = arc_through({kFurthest, 1}, {1, 0});
  ASSERT_FALSE(around_it);
  EXPECT_EQ(around_it.error().reason, Reason::out_of_range);
  EXPECT_EQ(reason_of(arc_through({-kFurthest, 1}, {1, 0})), Reason::out_of_range);
  // Slightly wider than the possible 2 * 999,999,999 pulses, one axis at a time.
  EXPECT_EQ(reason_of(arc_through({900'000'000, kFurthest}, {0, 1})), Reason::out_of_range);
  EXPECT_EQ(reason_of(arc_through({kFurthest, 900'000'000}, {1, 0})), Reason::out_of_range);
  EXPECT_TRUE(arc_through({kFurthest, kFurthest}, {1, 0}));
  const auto flat = arc_through({500'000, 1}, {1'000'000, 0});
  ASSERT_TRUE(flat);
  EXPECT_EQ(reason_of(other_way(*flat)), Reason::out_of_range);
  EXPECT_TRUE(arc_through({1'000, 1'000'000}, {1, 0})) << "large, but there is room";
}

TEST(Arc, AnglesHaveTheManualsRange) {
  const PlanePoint center{1000, 0};
  const Rotation way = Rotation::clockwise;
  for (const double degrees : {0.0, -90.0, 360.001, 540.0, std::numeric_limits<double>::quiet_NaN(),
                               std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(reason_of(arc_by_angle(center, degrees, way)), Reason::out_of_range) << degrees;
  }
  EXPECT_EQ(arc_by_angle(center, 540, way).error().message,
            "an arc of 540 degrees; above 0 and up to 360 are possible (manual 72) E:1)");
  for (const double degrees : {0.000001, 360.0}) EXPECT_TRUE(arc_by_angle(center, degrees, way)) << degrees;
  for (const double degrees : {0.0, -1.0, 360000.1}) {
    EXPECT_EQ(reason_of(helix_by_angle(center, degrees, way, 5)), Reason::out_of_range) << degrees;
  }
  for (const double degrees : {0.000001, 540.0, 360000.0}) EXPECT_TRUE(helix_by_angle(center, degrees, way, 5));
  for (const int turns : {0, -1, 1001}) {
    EXPECT_EQ(reason_of(helix_of_turns(center, turns, way, 5)), Reason::out_of_range) << turns;
  }
}

TEST(Arc, TheThirdAxisGoesAlongEvenly) {
  // Manual 74): 100 pulses in each of two turns are 200.
  const auto turns = helix_of_turns({0, 5000}, 2, Rotation::clockwise, -100);
  ASSERT_TRUE(turns);
  EXPECT_EQ(end_of(*turns), (ArcEnd{0, 0, -200}));
  EXPECT_EQ(text(extent_of(*turns)), "[-5000 5000] [0 10000] [-200 0]");
  EXPECT_DOUBLE_EQ(length_of(*turns), std::hypot(4 * kPi * 5000, 200));
  // Manual 75): 100 pulses a turn are 150 at 540 degrees; below one turn the amount is that of the whole arc.
  const auto rise = [](double degrees, std::int64_t amount) {
    return end_of(*helix_by_angle({0, 100}, degrees, Rotation::clockwise, amount)).third;
  };
  EXPECT_EQ(rise(540, 100), 150);
  EXPECT_EQ(rise(90, 50), 50);
  EXPECT_EQ(rise(359.9, 100), 100);
  EXPECT_EQ(rise(360, 100), 100);
  EXPECT_EQ(extent_of(*helix_by_angle({0, 100}, 540, Rotation::clockwise, -5)).third, (Extent{-8, 0})) << "7.5 pulses";
  EXPECT_EQ(rise(360'000, -kFurthest), -999'999'999'000);
  const auto quarter = helix_by_angle({0, 100}, 90, Rotation::clockwise, 50);
  EXPECT_EQ(end_of(*quarter), (ArcEnd{-100, 100, 50}));
  EXPECT_EQ(text(extent_of(*quarter)), "[-100 0] [0 100] [0 50]");
  // Manual 76): the amount is the third axis's end position.
  EXPECT_EQ(end_of(*helix_through({-5000, 3000}, {-8000, 12000}, 10000)), (ArcEnd{-8000, 12000, 10000}));
}

TEST(Arc, AThousandTurnsEndWhereTheyBegan) {
  for (const Rotation way : {Rotation::clockwise, Rotation::counterclockwise}) {
    const auto widest = helix_of_turns({kFurthest, -kFurthest}, 1000, way, 0);
    ASSERT_TRUE(widest);
    EXPECT_EQ(end_of(*widest), ArcEnd{});
    EXPECT_EQ(text(extent_of(*widest)), text(extent_of(whole_circle({kFurthest, -kFurthest}, way))));
  }
}

// Manual 71): the composite speed is S of the lower axis; 77): 0.5 mm/s, 10 nm a pulse.
TEST(Arc, ItsSpeedIsTheSameThroughout) {
  const Arc circle = whole_circle({5000, -5000}, Rotation::clockwise);
  EXPECT_NEAR(std::chrono::duration<double>(duration_of(circle, 50'000)).count(),
              2 * kPi * 5000 * std::numbers::sqrt2 / 50'000, 1e-9);
  const auto helix = helix_of_turns({0, 5000}, 2, Rotation::clockwise, 2000);
  EXPECT_NEAR(std::chrono::duration<double>(duration_of(*helix, 1000)).count(), std::hypot(4 * kPi * 5000, 4000) / 1000,
              1e-9);
  EXPECT_EQ(duration_of(*helix_of_turns({kFurthest, kFurthest}, 1000, Rotation::clockwise, 0), 1),
            std::chrono::seconds(1'000'000'000));
}

TEST(Arc, WithItsCenterWhereItStandsItGoesNowhere) {
  const Arc none = whole_circle({0, 0}, Rotation::clockwise);
  EXPECT_EQ(end_of(none), ArcEnd{});
  EXPECT_EQ(text(extent_of(none)), "[0 0] [0 0] [0 0]");
  EXPECT_EQ(length_of(none), 0);
  EXPECT_EQ(duration_of(none, 1000), Duration::zero());
  EXPECT_EQ(length_of(*helix_of_turns({0, 0}, 2, Rotation::clockwise, -50)), 100);
}

}  // namespace
}  // namespace axisgate::shrc203::arc_test
