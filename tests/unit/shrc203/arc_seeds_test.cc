// Comparison of arcs and helices (manual 71) to 82)) with the geometry of their circles and with the simulator, in
// thousands of cases from fixed seeds.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "device/shrc203/planning/arc.h"
#include "device/shrc203/simulator/motion/arcs.h"
#include "device/shrc203/stage.h"
#include "tests/simulation/random.h"

namespace axisgate::shrc203::arc_seeds_test {
namespace {

using simulation::Random;

constexpr std::int64_t kAmountMax = 999'999'999;
constexpr int kCases = 2000;
constexpr int kSamples = 2000;

struct Point {
  double x = 0;
  double y = 0;
};

double distance(Point a, Point b) { return std::hypot(a.x - b.x, a.y - b.y); }
Point as_point(PlanePoint point) { return {static_cast<double>(point.first), static_cast<double>(point.second)}; }

bool contains(const Extent& extent, double value, double tolerance) {
  return value >= static_cast<double>(extent.lowest) - tolerance &&
         value <= static_cast<double>(extent.highest) + tolerance;
}

// Returns a coordinate of any size that a command can carry, with either sign; 0 in one case of ten.
std::int64_t coordinate(Random& random) {
  if (random.chance(0.1)) return 0;
  std::int64_t size = 1;
  for (std::int64_t i = random.between(0, 8); i > 0; --i) size *= 10;
  const std::int64_t amount = std::min(random.between(1, size * 10), kAmountMax);
  return random.chance(0.5) ? amount : -amount;
}

PlanePoint point(Random& random) { return {coordinate(random), coordinate(random)}; }

PlanePoint point_elsewhere(Random& random) {
  PlanePoint made = point(random);
  while (made == PlanePoint{}) made = point(random);
  return made;
}

Rotation rotation(Random& random) { return random.chance(0.5) ? Rotation::clockwise : Rotation::counterclockwise; }

// Returns points along the arc around `center` that starts at 0,0, in order; `sweep` in radians, positive
// counterclockwise.
std::vector<Point> sampled(Point center, double sweep) {
  std::vector<Point> places;
  for (int i = 0; i <= kSamples; ++i) {
    const double angle = sweep * i / kSamples;
    // Vector from the center to the start, rotated by the angle.
    const double x = -center.x * std::cos(angle) + center.y * std::sin(angle);
    const double y = -center.x * std::sin(angle) - center.y * std::cos(angle);
    places.push_back({center.x + x, center.y + y});
  }
  return places;
}

// Computes the center from the arc's own data: it is perpendicular to the heading at the start.
Point center_of(const Arc& arc) {
  const double side = arc.sweep < 0 ? -1 : 1;
  return {-side * arc.radius * std::sin(arc.heading), side * arc.radius * std::cos(arc.heading)};
}

// Checks one coordinate: no sample is outside, each bound is the start, the end or the edge of the circle, rounded
// outwards, and a sample is close to each bound.
void expect_bounds(const Extent& extent, const std::vector<double>& samples, double center, const Arc& arc,
                   double tolerance) {
  const double step = arc.sweep / kSamples;
  const double between_samples = arc.radius * step * step / 8;
  for (const auto& [bound, outwards] : {std::pair{extent.lowest, -1.0}, std::pair{extent.highest, 1.0}}) {
    const double outermost = outwards * std::ranges::max(samples, {}, [&](double place) { return outwards * place; });
    const double limit = outwards * static_cast<double>(bound);
    EXPECT_LE(outermost, limit + tolerance);
    const auto is_touched = [&](double place) {
      const double slack = limit - outwards * place;
      return slack > -tolerance && slack < 1 + tolerance && outwards * place < outermost + between_samples + tolerance;
    };
    EXPECT_TRUE(is_touched(0) || is_touched(samples.back()) || is_touched(center + outwards * arc.radius))
        << bound << " is not touched";
  }
}

void expect_extent_of(const std::vector<Point>& places, Point center, const Arc& arc, double tolerance) {
  std::vector<double> first, second;
  for (const Point place : places) {
    first.push_back(place.x);
    second.push_back(place.y);
  }
  const ArcExtent extent = extent_of(arc);
  expect_bounds(extent.first, first, center.x, arc, tolerance);
  expect_bounds(extent.second, second, center.y, arc, tolerance);
}

void expect_on(const ArcEnd& end, Point place, double tolerance) {
  EXPECT_NEAR(static_cast<double>(end.first), place.x, 0.5 + tolerance);
  EXPECT_NEAR(static_cast<double>(end.second), place.y, 0.5 + tolerance);
}

// Checks an arc of `degrees` around `center`, however the arc was made.
void expect_turned(const Arc& arc, PlanePoint center, double degrees, Rotation way) {
  const double sweep = (way == Rotation::clockwise ? -1 : 1) * degrees * std::numbers::pi / 180;
  const Point middle = as_point(center);
  const double radius = distance(middle, {});
  const double tolerance = 2e-3 + 1e-14 * radius * std::abs(sweep);
  const auto places = sampled(middle, sweep);
  EXPECT_LT(distance(center_of(arc), middle), tolerance);
  expect_on(end_of(arc), places.back(), tolerance);
  expect_extent_of(places, middle, arc, tolerance);
  EXPECT_EQ(rotation_of(arc), way);
  EXPECT_NEAR(length_of(arc), std::hypot(radius * sweep, arc.rise), 1e-9 * length_of(arc));
}

TEST(ArcSeeds, AnglesEndWhereTheCircleIsThen) {
  constexpr std::uint64_t kSeed = 71;
  Random random(kSeed);
  for (int i = 0; i < kCases && !testing::Test::HasFailure(); ++i) {
    const PlanePoint center = point_elsewhere(random);
    const double degrees = random.chance(0.3) ? static_cast<double>(random.between(1, 8)) * 45
                                              : static_cast<double>(random.between(1, 360'000)) / 1000;
    const Rotation way = rotation(random);
    SCOPED_TRACE(fmt::format("seed {} case {}: center {} {}, {} degrees, d {}", kSeed, i, center.first, center.second,
                             degrees, static_cast<int>(way)));
    const auto arc = arc_by_angle(center, degrees, way);
    ASSERT_TRUE(arc) << arc.error().message;
    expect_turned(*arc, center, degrees, way);
  }
}

TEST(ArcSeeds, AWholeCircleReturns) {
  constexpr std::uint64_t kSeed = 72;
  Random random(kSeed);
  for (int i = 0; i < kCases && !testing::Test::HasFailure(); ++i) {
    const PlanePoint center = point_elsewhere(random);
    const Rotation way = rotation(random);
    SCOPED_TRACE(fmt::format("seed {} case {}: center {} {}, d {}", kSeed, i, center.first, center.second,
                             static_cast<int>(way)));
    const Arc arc = whole_circle(center, way);
    expect_turned(arc, center, 360, way);
    EXPECT_EQ(end_of(arc), ArcEnd{});
    EXPECT_EQ(extent_of(arc), extent_of(*arc_by_angle(center, 360, way)));
  }
}

TEST(ArcSeeds, GoesThroughThePassingPointToTheEnd) {
  constexpr std::uint64_t kSeed = 73;
  Random random(kSeed);
  int made = 0;
  for (int i = 0; i < 2 * kCases && !testing::Test::HasFailure(); ++i) {
    const PlanePoint passing = point(random), end = point(random);
    SCOPED_TRACE(
        fmt::format("seed {} case {}: {} {} to {} {}", kSeed, i, passing.first, passing.second, end.first, end.second));
    const auto arc = arc_through(passing, end);
    // Arcs with a larger radius have their own test: their center is too far away to compute with here.
    if (!arc || arc->radius > 1e10) continue;
    ++made;
    const Point center = center_of(*arc);
    const double tolerance = 2e-3 + 1e-14 * arc->radius;
    EXPECT_NEAR(distance(center, as_point(passing)), arc->radius, tolerance);
    EXPECT_NEAR(distance(center, as_point(end)), arc->radius, tolerance);
    EXPECT_EQ(end_of(*arc), (ArcEnd{end.first, end.second, 0}));
    const auto places = sampled(center, arc->sweep);
    const auto nearest = [&](PlanePoint to) {
      double least = std::numeric_limits<double>::infinity();
      for (const Point place : places) least = std::min(least, distance(place, as_point(to)));
      return least;
    };
    const double step = arc->radius * std::abs(arc->sweep) / kSamples;
    EXPECT_LE(nearest(passing), step / 2 + tolerance) << "it goes the other way around";
    EXPECT_LT(distance(places.back(), as_point(end)), tolerance);
    expect_extent_of(places, center, *arc, tolerance);
  }
  EXPECT_GT(made, kCases);
}

TEST(ArcSeeds, TheOtherWayIsTheRestOfTheCircle) {
  constexpr std::uint64_t kSeed = 74;
  Random random(kSeed);
  int made = 0;
  for (int i = 0; i < kCases && !testing::Test::HasFailure(); ++i) {
    const PlanePoint passing{random.between(-999, 999), random.between(-999, 999)};
    const PlanePoint end{random.between(-999, 999), random.between(-999, 999)};
    SCOPED_TRACE(
        fmt::format("seed {} case {}: {} {} to {} {}", kSeed, i, passing.first, passing.second, end.first, end.second));
    const auto one = helix_through(passing, end, 70);
    if (!one) continue;
    ++made;
    const auto other = other_way(*one);
    ASSERT_TRUE(other) << other.error().message;
    EXPECT_LT(distance(center_of(*one), center_of(*other)), 1e-12 * one->radius + 1e-6);
    EXPECT_EQ(end_of(*other), (ArcEnd{end.first, end.second, 70}));
    EXPECT_NE(rotation_of(*one), rotation_of(*other));
    EXPECT_NEAR(std::abs(one->sweep) + std::abs(other->sweep), 2 * std::numbers::pi, 1e-12);
    expect_extent_of(sampled(center_of(*other), other->sweep), center_of(*other), *other, 1e-3 + 1e-14 * one->radius);
  }
  EXPECT_GT(made, kCases / 2);
}

TEST(ArcSeeds, HelicesAreTheirCirclesFromAbove) {
  constexpr std::uint64_t kSeed = 75;
  Random random(kSeed);
  for (int i = 0; i < kCases && !testing::Test::HasFailure(); ++i) {
    const PlanePoint center = point_elsewhere(random);
    const Rotation way = rotation(random);
    const std::int64_t rise = coordinate(random);
    const int turns = static_cast<int>(random.between(1, 4));
    const double degrees = static_cast<double>(random.between(1, 1'440'000)) / 1000;
    SCOPED_TRACE(fmt::format("seed {} case {}: center {} {}, {} turns, {} degrees, d {}, rise {}", kSeed, i,
                             center.first, center.second, turns, degrees, static_cast<int>(way), rise));
    const auto whole = helix_of_turns(center, turns, way, rise);
    ASSERT_TRUE(whole);
    expect_turned(*whole, center, 360.0 * turns, way);
    const auto part = helix_by_angle(center, degrees, way, rise);
    ASSERT_TRUE(part);
    expect_turned(*part, center, degrees, way);
    const Extent third = extent_of(*part).third;
    EXPECT_EQ(rise < 0 ? third.highest : third.lowest, 0);
    EXPECT_NEAR(static_cast<double>(rise < 0 ? third.lowest : third.highest),
                static_cast<double>(rise) * std::max(degrees / 360, 1.0), 1.001);
  }
}

// The simulator computes independently: each coordinate as a cosine around the center.
void expect_like(const simulator::Arc& sent, const Arc& arc) {
  const simulator::ArcPath path = simulator::path_of(sent);
  const ArcExtent extent = extent_of(arc);
  for (int i = 0; i <= 200; ++i) {
    EXPECT_TRUE(contains(extent.first, static_cast<double>(path.plane[0].offset(i / 200.0)), 0)) << i;
    EXPECT_TRUE(contains(extent.second, static_cast<double>(path.plane[1].offset(i / 200.0)), 0)) << i;
  }
  // An end halfway between two pulses may be rounded either way.
  EXPECT_LE(std::abs(end_of(arc).first - path.plane[0].end), 1);
  EXPECT_LE(std::abs(end_of(arc).second - path.plane[1].end), 1);
  EXPECT_EQ(end_of(arc).third, path.linear);
  EXPECT_NEAR(length_of(arc), path.length,
              0.5 + 1e-9 * path.length);  // the rise is rounded before the length is computed
}

TEST(ArcSeeds, TheSimulatedControllerStaysWithinItAndEndsThere) {
  constexpr std::uint64_t kSeed = 76;
  Random random(kSeed);
  for (int i = 0; i < kCases && !testing::Test::HasFailure(); ++i) {
    const PlanePoint one{random.between(-9999, 9999), random.between(-9999, 9999)};
    const PlanePoint two{random.between(-9999, 9999), random.between(-9999, 9999)};
    const Rotation way = rotation(random);
    const std::int64_t degrees = random.between(1, 360), rise = random.between(-9999, 9999);
    const int d = static_cast<int>(way), turns = static_cast<int>(random.between(1, 5));
    if (one == PlanePoint{}) continue;
    SCOPED_TRACE(fmt::format("seed {} case {}: {} {}, {} {}, d {}, {} degrees, {} turns, rise {}", kSeed, i, one.first,
                             one.second, two.first, two.second, d, degrees, turns, rise));
    expect_like({0, d, {}, {}, {one.first, one.second}}, whole_circle(one, way));
    expect_like({1, d, {}, simulator::Number{degrees, 0}, {one.first, one.second}},
                *arc_by_angle(one, static_cast<double>(degrees), way));
    expect_like({3, d, turns, {}, {one.first, one.second, rise}}, *helix_of_turns(one, turns, way, rise));
    expect_like({4, d, {}, simulator::Number{degrees * 3, 0}, {one.first, one.second, rise}},
                *helix_by_angle(one, static_cast<double>(degrees * 3), way, rise));
    const auto through = arc_through(one, two);
    if (!through || through->radius > 1e9) continue;
    expect_like({2, d, {}, {}, {one.first, one.second, two.first, two.second}}, *through);
    expect_like({5, d, {}, {}, {one.first, one.second, two.first, two.second, rise}}, *helix_through(one, two, rise));
  }
}

}  // namespace
}  // namespace axisgate::shrc203::arc_seeds_test
